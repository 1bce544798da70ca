// SPDX-License-Identifier: BSD-2-Clause
// The page as a visitor and an embedding page meet it: node first.mjs chromium|firefox COMMAND FOLDER [full]; in the build folder.
// FOLDER has s.adcgs, share.html (with s.adcgs in it), evil.html (with hostile texts) and player.html. ADCGS_SHOTS names a folder
// for screenshots. Exits with 1 if something is wrong.
import { readFileSync } from 'node:fs';
import { at, browser, check, full, go, kind, restart, run, runParts, same, samePicture, shot, urlOf,
         withServer } from './page_kit.mjs';

const shots = process.env.ADCGS_SHOTS;
const SEEN = `const seen = id => { const e = document.getElementById(id); return e !== null && e.checkVisibility(); };
    const click = id => document.getElementById(id).click();`;
const see = script => run(SEEN + script);
const query = (text = '') => `?autoplay=0${text}`;

/** Go to a page without our script. */
async function goUntil(url, condition) {
    await browser.go(url);
    for (let i = 0; i < 300 && !await browser.run(`return Boolean(${condition});`); i++)
        await new Promise(done => setTimeout(done, 50));
}

/** A page with a frame: the one without a scene becomes it. */
const FRAME = '<!doctype html><link rel="icon" href="data:,"><iframe id="f" width="400" height="300" allow="fullscreen"></iframe>';
const framing = page => /id="scene"/.test(page) ? page : FRAME;

/** The poster is painted while the decoder is still on its way. */
async function firstPaint() {
    let release;
    const over = new Promise(done => { release = done; });
    await withServer(async host => {
        await goUntil(`${host}/player.html`, 'document.getElementById("f")');
        const got = await browser.run(`const frame = document.getElementById('f');
            frame.src = '/share.html?autoplay=0';
            const painted = () => frame.contentWindow.performance.getEntriesByName('first-contentful-paint').length > 0;
            for (let i = 0; i < 500 && !painted(); i++)
                await new Promise(done => setTimeout(done, 20));
            const inside = frame.contentDocument, box = inside.getElementById('still').getBoundingClientRect();
            return [painted(), frame.contentWindow.adcgs === undefined, Math.round(box.height), inside.querySelector('h1').textContent];`);
        same(got, [true, true, 400, 's'], 'painted before the script, with the poster, which fills the frame, and the title');
        release();
        await browser.run(`const frame = document.getElementById('f');
            for (let i = 0; i < 3000 && !frame.contentDocument.querySelector('.shown'); i++)
                await new Promise(done => setTimeout(done, 20));
            if (!frame.contentDocument.querySelector('.shown'))
                throw new Error('no image after the poster');`);
        for (const [width, height] of [[400, 300], [120, 390], [390, 100]]) {
            const [poster, scene] = await browser.run(`const frame = document.getElementById('f'), inside = frame.contentWindow;
                Object.assign(frame, { width: ${width}, height: ${height} });
                const { call } = inside.adcgs.view, resized = () => [0, 1].every(axis =>
                    (call.view_inset(axis) > 0) === (${width !== 400} && axis === ${width > height ? 0 : 1}));
                for (let i = 0; i < 500 && !resized(); i++)
                    await new Promise(done => setTimeout(done, 20));
                const box = inside.document.getElementById('poster').getBoundingClientRect();
                return [[box.left, box.top], [call.view_inset(0) * inside.innerWidth, call.view_inset(1) * inside.innerHeight]];`);
            check(Math.abs(poster[0] - scene[0]) < 1 && Math.abs(poster[1] - scene[1]) < 1 && (width === 400 || scene[0] + scene[1] > 5),
                  `the poster in ${width}x${height} begins at ${poster}, the scene at ${scene}`);
        }
    }, {}, framing, { at: '<script type="text/plain" id="worker-text">', over });
}

/** The scene plays without a click, and is exact when it pauses. */
async function playing() {
    await go(urlOf('share.html'));
    const got = await see(`await until(() => adcgs.playing && document.querySelector('.shown'), 'playing');
        const loops = adcgs.view.call.view_loop(), shown = ['empty', 'failure', 'bar', 'hint', 'facts', 'help', 'begin'].map(seen);
        await until(() => adcgs.view.call.view_frame() > 0 && (!adcgs.gpu || adcgs.fast.tookMs > 0), 'next frame, paced by the GPU');
        adcgs.pause();
        await settled();
        return { loops, shown, ...report() };`);
    same(got.shown, [false, false, true, true, false, false, false], 'empty, failure, bar, hint, facts, help, begin while playing');
    same(got.loops, 1, 'it plays in a loop');
    samePicture(got.picture, at('s.adcgs'), 'the image after a pause');
}

/** Where scripts may not run, the poster and the title stay. */
async function withoutScripts() {
    for (const policy of ['sandbox', "script-src 'none'"])
        await withServer(async host => {
            await goUntil(`${host}/share.html`, 'document.getElementById("silent") || document.getElementById("card")');
            const got = await browser.run(`const box = document.getElementById('still').getBoundingClientRect();
                const seen = id => document.getElementById(id)?.checkVisibility() === true;
                return [box.width > 300, document.querySelector('#card h1').textContent, window.adcgs === undefined,
                        ['bar', 'empty', 'failure', 'begin', 'progress'].some(seen), seen('silent')];`);
            same(got, [true, 's', true, false, policy === 'sandbox'], `poster, title, no script, no controls, a word: ${policy}`);
        }, { 'content-security-policy': policy });
}

/** The policy of the man page lets the page work. */
async function policy() {
    const man = readFileSync(`${process.env.srcdir || '.'}/man/adcgs-share.1`, 'utf8').replace(/\\-/g, '-');
    const text = /^Content-Security-Policy: (.*)$/m.exec(man)[1];
    await withServer(async host => {
        for (const page of ['share.html?autoplay=0', 'player.html?autoplay=0&src=s.adcgs']) {
            await go(`${host}/${page}`);
            const got = await run('await settled(); return report();');
            same(got.state, 'complete', `${page} with the policy of the man page`);
        }
    }, { 'content-security-policy': text });
}

/** Hostile texts are texts. */
async function hostile() {
    await go(urlOf('evil.html', query()));
    const got = await run(`await settled();
        return [document.title, document.querySelector('h1').textContent, document.querySelector('#card p').textContent, window.evil];`);
    const text = '</script></title>"\'--><script>evil=1</script><img src=x onerror=evil=1>&\\';
    same(got, [text, text, text, kind === 'firefox' ? null : undefined].slice(0, got.length), 'hostile texts');
}

/** ?t= &camera= &noui &poster. */
async function address() {
    const file = at('s.adcgs');
    await go(urlOf('share.html', query('&t=0.1&camera=1')));
    let got = await run('await settled(); return { ...report(), cameras: adcgs.cameras, duration: adcgs.duration };');
    same(got.picture.time, 0.1, '?t=0.1');
    samePicture(got.picture, file, '?camera=1&t=0.1', '--camera', '1');
    await go(urlOf('share.html', query(`&camera=nobody&t=99&noui`)));
    got = await see(`await settled(); return { ...report(), noui: ['bar', 'card', 'hint'].map(seen), last: adcgs.view.call.view_frame() };`);
    check(/no camera “nobody”/.test(got.message), `an unknown camera: "${got.message}"`);
    same(got.noui, [false, false, false], '?noui');
    check(got.last > 0, '?t= beyond the end');
    await browser.go(urlOf('share.html', '?poster'));
    got = await see(`await until(() => window.adcgs && adcgs.state === 'waiting', 'waiting page'); await sleep(100);
        const before = [adcgs.view === undefined || !adcgs.module, seen('begin'), seen('poster')];
        click('begin');
        await until(() => adcgs.playing, 'playing after a click');
        return [...before, seen('begin')];`);
    same(got, [true, true, true, false], '?poster: nothing starts, a button, the poster; no button afterwards');
}

/** window.adcgs, as the man page describes it. */
async function api() {
    await go(urlOf('share.html', query()));
    const got = await run(`await settled();
        const frames = [], clock = [], off = adcgs.on('frame', detail => frames.push(detail));
        ['play', 'pause'].forEach(event => adcgs.on(event, () => clock.push(event)));
        const next = async act => {
            const n = frames.length;
            act();
            await until(() => frames.slice(n).some(frame => frame.exact), 'exact frame');
            return adcgs.picture;
        };
        const half = await next(() => adcgs.seek(adcgs.duration / 2)), camera = await next(() => adcgs.setCamera(1));
        const home = await next(() => adcgs.setCamera('home'));
        const moved = await next(() => adcgs.setCamera({ position: [3, -3, 2], target: [0, 0, 0.5] }));
        const wrong = [() => adcgs.seek('x'), () => adcgs.setCamera('nobody'), () => adcgs.setCamera({ position: [0, 0, 0], target: [0, 0, 0] })]
            .map(act => { try { act(); return ''; } catch (e) { return e.name; } });
        adcgs.play();
        await until(() => adcgs.playing && frames.at(-1).time !== half.time, 'playing');
        adcgs.pause();
        await until(() => clock.length === 2, 'pause');
        await settled();
        off();
        const n = frames.length;
        adcgs.seek(0);
        await until(() => adcgs.picture.time === 0, 'first frame');
        return { half, camera, home, moved, wrong, clock, ended: frames.length === n, playing: adcgs.playing };`);
    const file = at('s.adcgs');
    samePicture(got.half, file, 'seek');
    samePicture(got.camera, file, 'setCamera(1)', '--camera', '1');
    same(got.home.digest, got.half.digest, 'setCamera("home")');
    check(new Set([got.moved.digest, got.camera.digest, got.home.digest]).size === 3, 'setCamera() to a place');
    same(got.wrong, ['TypeError', 'RangeError', 'TypeError'], 'wrong arguments');
    same([got.clock, got.ended, got.playing], [['play', 'pause'], true, false], 'events');
}

/** A page that embeds this one, from another origin, by messages. */
async function embedded() {
    await withServer(async host => {
        await goUntil(`${host}/player.html`, 'document.getElementById("f")');
        const got = await browser.run(`const frame = document.getElementById('f'), messages = [];
            const has = async test => {
                for (let i = 0; i < 3000 && !messages.some(test); i++)
                    await new Promise(done => setTimeout(done, 20));
                return messages.find(test);
            };
            addEventListener('message', event => event.source === frame.contentWindow && messages.push(event.data));
            const send = (adcgs, value) => frame.contentWindow.postMessage({ adcgs, value }, '*');
            frame.src = location.origin.replace('127.0.0.1', 'localhost') + '/share.html?autoplay=0';
            const ready = await has(m => m.adcgs === 'ready');
            send('on', 'frame');
            send('seek', ready.duration);
            const last = await has(m => m.adcgs === 'frame' && m.time > 0);
            send('setCamera', 'nobody');
            const error = await has(m => m.adcgs === 'error');
            send('on', 'play');
            send('play');
            const play = await has(m => m.adcgs === 'play');
            send('openScene');
            return [ready.title, last.time > 0, /no camera/.test(error.message), play !== undefined];`);
        same(got, ['s', true, true, true], 'title, frame, error and play in messages of a frame');
        await goUntil(`${host}/player.html`, 'document.getElementById("f")');
        const button = await browser.run(`const frame = document.getElementById('f');
            frame.src = '/share.html?autoplay=0';
            for (let i = 0; i < 3000 && frame.contentWindow.adcgs?.state !== 'complete'; i++)
                await new Promise(done => setTimeout(done, 20));
            return [frame.contentDocument.fullscreenEnabled, frame.contentDocument.getElementById('full').hidden];`);
        same(button, [true, false], 'full screen from within a frame');
    }, {}, framing);
}

/** Keys wherever the focus is, names for screen readers, panels, a failure and the way on. */
async function controls() {
    await go(urlOf('share.html', query()));
    const got = await see(`await settled();
        const type = (id, key) => { const e = document.getElementById(id); e.focus();
            return e.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true })); };
        const loops = () => document.getElementById('loop').getAttribute('aria-pressed');
        const before = loops(), mine = type('time', 'ArrowRight');
        type('time', 'l'); await sleep(100); const slider = loops();
        type('play', 'l'); await sleep(100); const button = loops();
        type('shot', 'h'); await until(() => seen('help'), 'help');
        const twice = [...document.querySelectorAll('#help table')].findIndex(e => e.innerText.includes('orbit around this'));
        const focus = document.activeElement.id, wide = document.getElementById('help').scrollWidth <= innerWidth;
        pointer('pointerdown', 60, 200); pointer('pointerup', 60, 200); await sleep(100);
        const closed = !seen('help');
        click('more'); const facts = seen('facts'), module = /relaxed|exact$/.test(document.getElementById('details').innerText);
        const digest = document.getElementById('digest').checkVisibility();
        window.dispatchEvent(new KeyboardEvent('keydown', { key: 'Escape', bubbles: true })); const escaped = !seen('facts');
        adcgs.seek(adcgs.duration); await sleep(100);
        return { loops: [before, slider, button], mine, twice, focus, wide, closed, facts, module, digest, escaped,
                 nameless: [...document.querySelectorAll('button')].filter(b => !b.getAttribute('aria-label') && !b.innerText.trim() &&
                     b.checkVisibility()).map(b => b.id), glyphs: document.getElementById('buttons').innerText.replace(/[0-9./ s]/g, '').trim(),
                 spoken: document.getElementById('time').getAttribute('aria-valuetext'),
                 pressed: document.getElementById('play').getAttribute('aria-pressed') };`);
    same([got.loops, got.mine], [['true', 'false', 'true'], true], 'keys with the focus on the slider and on a button');
    same(got.twice, 0, 'a double click is among the actions of the mouse');
    same([got.focus, got.wide, got.closed, got.escaped], ['help', true, true, true], 'help: focus, width, a tap outside, escape');
    same([got.facts, got.digest, got.module], [true, true, false], 'information: open, with the digest, without the module');
    same([got.nameless, got.glyphs, got.pressed], [[], '', 'false'], 'names of buttons, glyphs, aria-pressed');
    check(/^\d+\.\d\d seconds$/.test(got.spoken), `the slider says "${got.spoken}"`);
    // Of a GPU in software, and where WebGPU has none.
    const messages = browser.messages.filter(text => !/GL Driver Message|No available adapters/.test(text));
    same(messages, [], 'messages of the console');
    await withServer(async host => {
        await go(`${host}/player.html?src=other.adcgs&autoplay=0`);
        const bytes = readFileSync(at('s.adcgs')).toString('base64');
        const failure = await see(`await until(() => adcgs.state === 'failed', 'failure');
            const text = document.getElementById('why').innerText, shown = [seen('failure'), seen('again'), seen('progress'), seen('bar')];
            drop('${bytes}', 's.adcgs'); await sleep(50); await settled();
            return { text, shown, after: [seen('failure'), seen('bar'), seen('card'), document.title] };`);
        check(/404/.test(failure.text), `a missing stream: "${failure.text}"`);
        same(failure.shown, [true, true, false, false], 'failure, another try, no progress, no bar');
        same(failure.after, [false, true, false, 's'], 'another file after a failure');
    });
}

/** Outside of the filmed region the image gets darker, and the first time a text says why. */
async function edge() {
    await go(urlOf('share.html', '?autoplay=0&draw=exact')); // a GPU in software stops the page for too long
    const got = await run(`await settled();
        const says = [], stage = document.getElementById('stage'), out = async (steps, deltaY) => {
            for (let i = 0; i < steps; i++) {
                stage.dispatchEvent(new WheelEvent('wheel', { deltaY, bubbles: true, cancelable: true }));
                await sleep(30);
            }
            says.push(/^Not filmed/.test(adcgs.message));
        };
        await out(1, 100);
        await out(40, 100);
        const dark = document.getElementById('exact').style.filter;
        await until(() => adcgs.message === '', 'end of the text');
        await out(40, -100);
        await out(40, 100);
        return [...says, /brightness/.test(dark), adcgs.first > 0];`);
    same(got, [false, true, false, false, true, true], 'the text near, far, near and far; darkness; the time of the first image');
}

/** Nothing moves by itself for a user who prefers that, unless the address says so. */
async function reducedMotion() {
    await restart(480, 360, { reduced: true });
    await go(urlOf('share.html'));
    const still = await run('await settled(); await sleep(200); return [adcgs.playing, adcgs.picture.time];');
    same(still, [false, 0], 'playing with reduced motion');
    await go(urlOf('share.html', '?autoplay'));
    await run(`await until(() => adcgs.playing, 'playing with ?autoplay');`);
}

/** Screenshots for people: each state in three sizes. */
async function pictures() {
    for (const [width, height, phone] of [[1280, 800, false], [390, 844, true], [844, 390, true]]) {
        const name = state => `page-${width}x${height}-${state}`;
        await restart(width, height, { phone });
        await browser.go(urlOf('share.html', '?poster'));
        await run(`await until(() => window.adcgs && adcgs.state === 'waiting', 'poster');`);
        await shot(name('first'));
        await go(urlOf('share.html'));
        await run(`await until(() => adcgs.playing && document.querySelector('.shown'), 'playing');
            adcgs.fades = document.getElementById('hint').hidden = false; await sleep(500);`);
        await shot(name('playing'));
        await run(`adcgs.pause(); document.getElementById('keys').click(); await settled(); await sleep(400);`);
        await shot(name('help'));
        await run(`document.getElementById('more').click(); await sleep(400);`);
        await shot(name('information'));
        await go(urlOf('player.html', '?src=other.adcgs'));
        await run(`await until(() => adcgs.state === 'failed', 'failure'); await sleep(200);`);
        await shot(name('error'));
        await go(urlOf('player.html'));
        await run(`await until(() => document.getElementById('empty').checkVisibility(), 'empty page');`);
        await shot(name('empty'));
    }
}

const parts = [firstPaint, playing, controls, withoutScripts, policy, hostile, address, api, embedded, edge, reducedMotion];
await runParts(shots ? [...parts, pictures] : parts, 480, 360);
