// SPDX-License-Identifier: BSD-2-Clause
// For the tests of the page: the browser of the command line, its pages, checks, servers. Arguments of the tests:
// chromium|firefox COMMAND FOLDER [full].
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { openBrowser } from './browser.mjs';

export const [kind, command, folder, full] = process.argv.slice(2);
const shots = process.env.ADCGS_SHOTS; // a folder for screenshots

export function check(condition, text) {
    if (!condition) {
        console.log(`FAILED: ${kind}: ${text}`);
        process.exitCode = 1;
    }
}

export function same(got, expected, text) {
    const [a, b] = [got, expected].map(value => JSON.stringify(value));
    check(a === b, `${text}: ${a}, expected ${b}`);
}

export const native = (...options) =>
    execFileSync('./adcgs-dec', ['--quiet', '--md5', ...options], { encoding: 'utf8' }).trim().split('\n');
export const at = name => join(folder, name);
export const urlOf = (name, query = '') => pathToFileURL(at(name)).href + query;

const HELPERS = `
const sleep = ms => new Promise(done => setTimeout(done, ms));
const until = async (what, why) => {
    for (let i = 0; i < 3000; i++) {
        if (what())
            return;
        await sleep(20);
    }
    throw new Error('no ' + why + ': ' + JSON.stringify(adcgs.state) + ' ' + adcgs.message + ' ' + JSON.stringify(adcgs.notes));
};
const isLast = () => adcgs.picture && adcgs.picture.generation === adcgs.generation;
const settled = () => until(() => adcgs.state === 'failed' || (adcgs.state === 'complete' && isLast()), 'image');
const pointer = (type, x, y, id = 1, kind = 'mouse') => document.getElementById('stage').dispatchEvent(new PointerEvent(type,
    { pointerId: id, pointerType: kind, clientX: x, clientY: y, button: 0, buttons: 1, bubbles: true }));
Element.prototype.setPointerCapture = () => undefined; // simulated pointers cannot be captured
const key = name => ['keydown', 'keyup'].forEach(type => document.getElementById('exact').dispatchEvent(
    new KeyboardEvent(type, { key: name, bubbles: true, cancelable: true })));
const drop = (bytes, name) => {
    const files = new DataTransfer();
    files.items.add(new File([Uint8Array.from(atob(bytes), c => c.charCodeAt(0))], name));
    window.dispatchEvent(new DragEvent('drop', { dataTransfer: files, bubbles: true, cancelable: true }));
};
const report = () => {
    const { state, message, picture, notes, module, drawn } = adcgs;
    return { state, message, picture, notes, module, threads: drawn ? drawn.threads : 0 };
};
`;

export let browser;
export const run = script => browser.run(HELPERS + script);
export async function go(url) {
    await browser.go(url);
    await run(`await until(() => window.adcgs && (adcgs.view || adcgs.state === 'failed'), 'page');`);
}
export async function shot(name) {
    if (shots)
        await browser.shot(join(shots, `${kind}-${name}.png`));
}

/** Compares the page's exact image with the program's. */
export function samePicture(picture, file, text, ...options) {
    const time = String(picture.time);
    const fit = options.includes('--fit') ? [] : ['--fill'];
    same(picture.digest,
         native(file, '--time', time, ...fit, '--size', `${picture.width}x${picture.height}`, ...options)[0], text);
}

/** A server that sends the stream in small pieces. It may send headers, change pages, and wait within them at a text. */
function serve(headers = {}, edit = text => text, pause = { at: '\0', over: null }) {
    const server = createServer((request, response) => {
        const name = new URL(request.url, 'http://host').pathname.slice(1);
        if (name.endsWith('.html')) {
            response.writeHead(200, { 'content-type': 'text/html', ...headers });
            const [first, ...rest] = edit(readFileSync(at(name), 'utf8')).split(pause.at);
            response.write(first);
            Promise.resolve(rest.length ? pause.over : null)
                .then(() => response.end(rest.length ? pause.at + rest.join(pause.at) : ''));
        } else if (name === 's.adcgs') {
            const data = readFileSync(at(name));
            let sent = 0;
            const more = () => {
                if (sent >= data.length)
                    return response.end();
                response.write(data.subarray(sent, sent += Math.ceil(data.length / 40)));
                setTimeout(more, 60);
            };
            response.setHeader('content-length', data.length);
            more();
        } else {
            response.statusCode = 404;
            response.end();
        }
    });
    return new Promise(resolve => server.listen(0, '127.0.0.1', () => resolve(server)));
}

export async function withServer(use, ...options) {
    const server = await serve(...options);
    try {
        await use(`http://127.0.0.1:${server.address().port}`);
    } finally {
        server.close();
        server.closeAllConnections();
    }
}

let profiles = 0;
/** Start a browser of this size in place of the last one. Options as for openBrowser(). */
export async function restart(width, height, options = {}) {
    if (browser)
        await browser.close();
    const profile = at(`profile-${kind}-${process.pid}-${++profiles}`), flags = ['--enable-unsafe-swiftshader', ...options.flags || []];
    mkdirSync(profile);
    browser = await openBrowser(kind, command, profile, { ...options, width, height, flags });
}

/** Run the tests, at first in a browser of this size. Options as for openBrowser(). */
export async function runParts(parts, width = 800, height = 600, options = {}) {
    await restart(width, height, options);
    try {
        for (const part of parts)
            await part().catch(e => check(false, `${part.name}: ${e.message}`));
    } finally {
        await browser.close();
    }
}
