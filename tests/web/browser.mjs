// SPDX-License-Identifier: BSD-2-Clause
// A headless browser, controlled by its own interface: Chromium through a pipe (its debugging protocol), Firefox through a socket
// (Marionette). No npm package is needed.
//
//   const browser = await openBrowser('chromium' or 'firefox', command, folder for its profile, { width, height });
//   await browser.go(url); await browser.run('script, which may return a promise'); await browser.shot('file.png');
//   await browser.click('#play'), as a user does; await browser.close();
//
// More options: flags of the command (Chromium), reduced (the user prefers less motion), phone (touch; in Firefox only the kind of pointer). browser.messages
// has the messages of the console (Chromium).
import { spawn } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';

const ANSWER_MS = 120000;

/** Pending requests by number, and their answers. */
class Questions {
    constructor() {
        this.waiting = new Map();
        this.last = 0;
    }

    ask(send) {
        const id = ++this.last;
        return new Promise((resolve, reject) => {
            const timer = setTimeout(() => this.answer(id, new Error('the browser does not answer')), ANSWER_MS);
            this.waiting.set(id, { resolve, reject, timer });
            send(id);
        });
    }

    answer(id, error, result) {
        const question = this.waiting.get(id);
        if (!question)
            return;
        clearTimeout(question.timer);
        this.waiting.delete(id);
        if (error)
            question.reject(error);
        else
            question.resolve(result);
    }
}

const isOver = process => process.exitCode !== null || process.signalCode !== null;

async function stop(process, ask) {
    const gone = isOver(process) ? null : new Promise(resolve => process.once('exit', resolve));
    await Promise.race([ask().catch(() => null), gone]);
    const timer = setTimeout(() => process.kill('SIGKILL'), 5000);
    await gone;
    clearTimeout(timer);
}

async function openChromium(command, profile, { width, height, flags = [], reduced, phone }) {
    const process = spawn(command, ['--headless', '--remote-debugging-pipe', '--no-sandbox', '--no-first-run',
        '--disable-dev-shm-usage',
        `--user-data-dir=${profile}`, `--window-size=${width},${height}`, ...flags,
        ...reduced ? ['--force-prefers-reduced-motion'] : [], 'about:blank'],
    { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    const questions = new Questions(), messages = [];
    let rest = '';
    process.stdio[4].setEncoding('utf8');
    process.stdio[4].on('data', data => {
        const parts = (rest + data).split('\0');
        rest = parts.pop();
        for (const message of parts.map(part => JSON.parse(part))) {
            questions.answer(message.id, message.error && new Error(message.error.message), message.result);
            if (['Log.entryAdded', 'Runtime.consoleAPICalled', 'Runtime.exceptionThrown'].includes(message.method))
                messages.push(JSON.stringify(message.params));
        }
    });
    process.stdio[3].on('error', () => null);
    const ask = (method, params = {}, sessionId) =>
        questions.ask(id => process.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + '\0'));
    const { targetId } = await ask('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await ask('Target.attachToTarget', { targetId, flatten: true });
    await ask('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: Boolean(phone) },
              sessionId);
    await ask('Emulation.setTouchEmulationEnabled', { enabled: Boolean(phone) }, sessionId);
    await ask('Log.enable', {}, sessionId);
    await ask('Runtime.enable', {}, sessionId);
    return {
        messages,
        go: url => ask('Page.navigate', { url }, sessionId),
        async run(script) {
            const { result, exceptionDetails } = await ask('Runtime.evaluate',
                { expression: `(async () => {${script}})()`, awaitPromise: true, returnByValue: true }, sessionId);
            if (exceptionDetails)
                throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
            return result.value;
        },
        async click(selector) {
            const { result } = await ask('Runtime.evaluate', { returnByValue: true, expression: `(() => {
                const box = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect();
                return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
            })()` }, sessionId);
            for (const type of ['mousePressed', 'mouseReleased'])
                await ask('Input.dispatchMouseEvent', { type, ...result.value, button: 'left', clickCount: 1 }, sessionId);
        },
        async shot(file) {
            const { data } = await ask('Page.captureScreenshot', { format: 'png' }, sessionId);
            writeFileSync(file, Buffer.from(data, 'base64'));
        },
        close: () => stop(process, () => ask('Browser.close')),
    };
}

async function openFirefox(command, profile, { width, height, reduced, phone }) {
    const settings = { 'marionette.port': 0, 'browser.shell.checkDefaultBrowser': false, 'app.update.enabled': false,
                       'datareporting.policy.dataSubmissionEnabled': false, 'webgl.force-enabled': true,
                       'ui.prefersReducedMotion': reduced ? 1 : 0,
                       ...phone ? { 'ui.primaryPointerCapabilities': 1, 'ui.allPointerCapabilities': 1 } : {} };
    writeFileSync(join(profile, 'user.js'),
                  Object.entries(settings).map(([name, value]) => `user_pref("${name}", ${value});\n`).join(''));
    const process = spawn(command, ['--headless', '--no-remote', '--marionette', '--profile', profile], { stdio: 'ignore' });
    const portFile = join(profile, 'MarionetteActivePort');
    for (let i = 0; !existsSync(portFile); i++) {
        if (i > 600 || isOver(process))
            throw new Error(`${command} does not start`);
        await new Promise(resolve => setTimeout(resolve, 100));
    }
    const socket = connect(Number(readFileSync(portFile, 'utf8')), '127.0.0.1');
    const questions = new Questions();
    let rest = Buffer.alloc(0), greeted;
    const greeting = new Promise(resolve => { greeted = resolve; });
    socket.on('error', () => null);
    socket.on('data', data => {
        rest = Buffer.concat([rest, data]);
        for (let colon; (colon = rest.indexOf(':')) > 0;) {
            const length = Number(rest.subarray(0, colon)), end = colon + 1 + length;
            if (rest.length < end)
                return;
            const message = JSON.parse(rest.subarray(colon + 1, end).toString());
            rest = rest.subarray(end);
            if (Array.isArray(message))
                questions.answer(message[1], message[2] && new Error(message[2].message), message[3]);
            else
                greeted();
        }
    });
    await greeting;
    const ask = (name, params = {}) => questions.ask(id => {
        const text = JSON.stringify([0, id, name, params]);
        socket.write(`${Buffer.byteLength(text)}:${text}`);
    });
    await ask('WebDriver:NewSession', { capabilities: { alwaysMatch: { pageLoadStrategy: 'normal' } } });
    await ask('WebDriver:SetTimeouts', { script: ANSWER_MS });
    await ask('WebDriver:SetWindowRect', { width, height: height + 85 });
    return {
        messages: [],
        go: url => ask('WebDriver:Navigate', { url }),
        async run(script) {
            const body = `const done = arguments[arguments.length - 1];
                (async () => {${script}})().then(value => done({ value }), e => done({ error: String(e && e.stack || e) }));`;
            const { value } = await ask('WebDriver:ExecuteAsyncScript', { script: body, args: [] });
            if (value.error)
                throw new Error(value.error);
            return value.value;
        },
        async click(selector) {
            const { value } = await ask('WebDriver:FindElement', { using: 'css selector', value: selector });
            await ask('WebDriver:ElementClick', { id: Object.values(value)[0] });
        },
        async shot(file) {
            const { value } = await ask('WebDriver:TakeScreenshot', { full: false });
            writeFileSync(file, Buffer.from(value, 'base64'));
        },
        close: () => stop(process, () => ask('Marionette:Quit', { flags: ['eForceQuit'] })),
    };
}

export function openBrowser(kind, command, profile, options = {}) {
    const size = { width: 800, height: 600, ...options };
    return kind === 'firefox' ? openFirefox(command, profile, size) : openChromium(command, profile, size);
}
