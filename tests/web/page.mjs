// SPDX-License-Identifier: BSD-2-Clause
// The page in a browser, compared with the programs: node page.mjs chromium|firefox COMMAND FOLDER [full]; in the build folder.
// FOLDER has s.adcgs, cut.adcgs, stub.adcgs (its first layer is cut off), bad.adcgs, share.html (with s.adcgs in it) and
// player.html. Prints the differences; exits with 1 if there are any. Pages here do not play at once.
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import * as kit from './page_kit.mjs';
import { at, check, full, go, kind, native, restart, run, runParts, same, samePicture, shot, withServer } from './page_kit.mjs';

const urlOf = (name, query = '?') => kit.urlOf(name, `${query}&autoplay=0`);

async function digests() {
    const expected = native(at('s.adcgs')), n = full ? expected.length : 3;
    for (const query of [`?md5=${n}`, '?md5=2&module=exact']) {
        await go(urlOf('share.html', query));
        await run(`await until(() => document.querySelector('#digests')?.dataset.done, 'digests');`);
        const got = await run(`return document.getElementById('digests').textContent.trim().split('\\n');`);
        same(got, expected.slice(0, got.length), `frames of share.html${query}`);
        check(got.length >= 2, 'too few frames');
        const { module, threads } = await run('return report();');
        same(module, query.includes('exact') ? 'exact' : 'relaxed', 'the module in use');
        same(threads, 1, 'threads of a page from a file');
    }
}

async function controls() {
    await go(urlOf('share.html'));
    await run('await settled();');
    let { picture } = await run('return report();');
    samePicture(picture, at('s.adcgs'), 'the first image');
    await shot('share');
    // The time bar, moved to its end.
    picture = await run(`const bar = document.getElementById('time');
        bar.value = bar.max;
        bar.dispatchEvent(new Event('input'));
        await until(() => adcgs.picture.time > 0, 'last frame');
        return adcgs.picture;`);
    samePicture(picture, at('s.adcgs'), 'the image at the end of the time bar');
    // Keys of the player.
    const before = await run(`key('Home'); await until(() => adcgs.picture.time === 0, 'first frame');
        key('i'); key('l'); key('h'); await sleep(100);
        return ['statistics', 'help'].map(id => document.getElementById(id).hidden).concat(adcgs.view.call.view_loop());`);
    same(before, [false, false, 0], 'statistics, help and loop by their keys');
    await shot('help');
    // Playback and pause.
    const played = await run(`key('h'); key('l'); key(' '); const n = adcgs.view.call.view_frame();
        await until(() => adcgs.view.call.view_frame() > n , 'playing');
        key(' ');
        return !adcgs.view.call.view_playing();`);
    check(played, 'playing');
    // A screenshot and the facts.
    const saved = await run(`HTMLAnchorElement.prototype.click = function () { adcgs.link = this.download; };
        key('Home'); await until(() => adcgs.picture.time === 0, 'first frame');
        key('p'); await until(() => adcgs.saved, 'screenshot');
        document.getElementById('more').click();
        return [adcgs.link, adcgs.saved.bytes > 100, document.getElementById('facts').hidden,
                document.getElementById('facts').textContent.includes('geometry')];`);
    same(saved, ['s-0.000.png', true, false, true], 'screenshot and facts');
    await shot('facts');
}

async function dropped() {
    await go(urlOf('player.html'));
    await shot('empty');
    const drops = [['s.adcgs', 'complete', /^$/], ['cut.adcgs', 'complete', /ends early/],
                   ['stub.adcgs', 'complete', /ends early/], ['bad.adcgs', 'complete', /damaged/, '--conceal'], ['none.adcgs', 'failed', /none\.adcgs: ./],
                   ['s.adcgs', 'complete', /^$/]];
    for (const [name, state, message, ...options] of drops) {
        const bytes = name === 'none.adcgs' ? Buffer.alloc(3000) : readFileSync(at(name));
        const got = await run(`drop('${bytes.toString('base64')}', '${name}'); await sleep(50); await settled();
            await until(() => adcgs.state === 'failed' || adcgs.picture, 'image'); return report();`);
        same(got.state, state, `${name} dropped`);
        check(message.test(got.message), `${name} dropped: "${got.message}"`);
        if (state === 'complete')
            samePicture(got.picture, at(name), `${name} dropped`, ...options);
    }
}

const ISOLATED = { 'cross-origin-opener-policy': 'same-origin', 'cross-origin-embedder-policy': 'require-corp' };

/** Images at both ends of the time bar equal the program's, once the given number of threads runs. */
async function drawnBy(url, threads, text) {
    await go(url);
    const got = await run(`await settled();
        const bar = document.getElementById('time'), pictures = [];
        for (let n = 0; n < 200 && (pictures.length < 2 || adcgs.drawn.threads < ${threads}); n++) {
            const before = adcgs.picture.time;
            bar.value = Number(bar.value) ? 0 : bar.max;
            bar.dispatchEvent(new Event('input'));
            await until(() => adcgs.drawn.exact && adcgs.picture.time !== before, 'image of another time');
            pictures.push(adcgs.picture);
        }
        key('i');
        await sleep(100);
        return { pictures: pictures.slice(-2), statistics: document.getElementById('statistics').textContent,
                 isolated: crossOriginIsolated, ...report() };`);
    same(got.threads, threads, `threads, ${text}`);
    check(got.statistics.includes(`, ${threads} thread${threads > 1 ? 's' : ''}\n`), `statistics, ${text}: ${got.statistics}`);
    for (const picture of got.pictures)
        samePicture(picture, at('s.adcgs'), `an image by ${threads} threads, ${text}`);
    return got;
}

/** Threads: if the server's headers allow them, one for each processor, or the number in the address; otherwise one. */
async function threads() {
    const page = 'share.html?draw=exact&autoplay=0';
    await withServer(async host => {
        const got = await drawnBy(`${host}/${page}&threads=3`, 3, 'isolated');
        same([got.isolated, got.module], [true, 'relaxed'], 'isolated, and the module');
        if (!full)
            return;
        const processors = await run('return navigator.hardwareConcurrency;');
        await drawnBy(`${host}/${page}`, Math.min(8, processors), 'one for each processor');
        await drawnBy(`${host}/${page}&threads=1`, 1, 'isolated, but one requested');
        await drawnBy(`${host}/${page}&threads=2&module=exact`, 2, 'by the exact module');
    }, ISOLATED);
    if (!full)
        return;
    await withServer(host => drawnBy(`${host}/${page}&threads=3`, 1, 'helpers fail'), ISOLATED,
                     text => text.replace('call.page_help();', 'throw new Error("a test");'));
    await withServer(host => drawnBy(`${host}/${page}&threads=3`, 1, 'no workers of workers'), ISOLATED,
                     text => text.replace('new Worker(self.location.href)', 'new NoWorker()'));
    await withServer(async host => {
        const { isolated } = await drawnBy(`${host}/${page}&threads=3`, 1, 'without headers');
        same(isolated, false, 'isolated without headers');
    });
}

async function served() {
    await withServer(async host => {
        await go(`${host}/player.html?src=s.adcgs&autoplay=0`);
        const early = await run(`await until(() => adcgs.pictures > 0, 'image'); return report();`);
        same(early.state, 'loading', 'an image while the stream arrives');
        const late = await run('await settled(); await sleep(300); return { pictures: adcgs.pictures, ...report() };');
        check(late.pictures > 1, `${late.pictures} images while the stream arrived`);
        samePicture(late.picture, at('s.adcgs'), 'the image of a received stream');
        await go(`${host}/player.html?src=other.adcgs`);
        const missing = await run(`await until(() => adcgs.state === 'failed', 'failure'); return report();`);
        check(/404/.test(missing.message), `a missing stream: "${missing.message}"`);
    });
}

/** A server that sends a stream, then endless zeros. Checks the number of bytes sent before the page closed the connection. */
async function endless(start, mibMost, see) {
    let sent = 0, gone = null;
    const hungUp = new Promise(done => { gone = done; });
    const server = createServer((request, response) => {
        const zeros = Buffer.alloc(65536);
        const more = () => {
            while (!response.destroyed && sent < 1024 * 1048576) {
                sent += zeros.length;
                if (!response.write(zeros))
                    return response.once('drain', () => setImmediate(more));
            }
            return response.end();
        };
        response.on('close', gone);
        if (new URL(request.url, 'http://x/').pathname !== '/endless.adcgs')
            return response.end(readFileSync(at('player.html')));
        response.write(start);
        return more();
    });
    await new Promise(done => server.listen(0, '127.0.0.1', done));
    await go(`http://127.0.0.1:${server.address().port}/player.html?src=endless.adcgs&autoplay=0`);
    await see(await run('await settled(); return report();'));
    await hungUp;
    server.close();
    server.closeAllConnections();
    // Firefox reads ahead of the page at loopback speed; it has to close the connection before the server ends.
    const most = kind === 'firefox' ? 1000 : mibMost;
    check(sent < most * 1048576, `an endless body: ${sent} bytes were sent`);
}

/** The page reads at most the stream's length; of a damaged stream the limit of its level; without a header that of level 2. */
async function bodiesWithoutEnd() {
    const stream = readFileSync(at('s.adcgs')), bad = readFileSync(at('bad.adcgs'));
    await endless(stream, 64, got => {
        same(got.message, '', 'message about an endless body');
        samePicture(got.picture, at('s.adcgs'), 'the image of an endless body');
    });
    await endless(bad, 64, got => check(/damaged/.test(got.message), `a damaged endless body: "${got.message}"`));
    if (!full)
        return;
    const headless = Buffer.from(stream);
    headless[30] ^= 1;
    await endless(headless, 400, got => check(got.state === 'failed', `an endless body without a header: ${got.state}`));
}

/** At the width of a phone, with touch. */
async function phone() {
    await restart(360, 640);
    await go(urlOf('share.html'));
    const got = await run(`await settled();
        const wide = document.documentElement.scrollWidth > innerWidth, n = adcgs.pictures, place = adcgs.picture.digest;
        const fingers = (type, d) => [[1, 180 - d], [2, 180 + d]].forEach(([id, x]) => pointer(type, x, 200, id, 'touch'));
        fingers('pointerdown', 20);
        for (let d = 20; d < 80; d += 10) {
            fingers('pointermove', d);
            await sleep(20);
        }
        fingers('pointerup', 80);
        await until(() => adcgs.picture.digest !== place && adcgs.drawn.exact, 'nearer image');
        return { wide, width: innerWidth };`);
    same(got.wide, false, `the page at ${got.width} pixels`);
    await shot('phone');
}

/** If relaxed SIMD does not fuse, the library detects it, and the other module is used. */
async function notFused() {
    if (kind !== 'chromium')
        return;
    await restart(800, 600, { flags: ['--js-flags=--no-enable-fma3'] });
    await go(urlOf('share.html', '?md5=2'));
    const got = await run(`await until(() => document.querySelector('#digests')?.dataset.done, 'digests');
        return { text: document.getElementById('digests').textContent.trim().split('\\n'), module: adcgs.module };`);
    same(got.text, native(at('s.adcgs')).slice(0, 2), 'frames where relaxed SIMD does not fuse');
    if (process.arch === 'x64')
        same(got.module, 'exact', 'the module where relaxed SIMD does not fuse');
}

await runParts(full ? [digests, controls, dropped, served, bodiesWithoutEnd, threads, phone, notFused]
                    : [digests, controls, dropped, bodiesWithoutEnd, threads]);
