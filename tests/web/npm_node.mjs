// SPDX-License-Identifier: BSD-2-Clause
// The npm package's decoder under node, compared with the programs: node npm_node.mjs PACKAGE FOLDER; in the build folder. FOLDER
// has s.adcgs and splats.ply, its splats at 0.1 s. Prints the differences; exits with 1 if there are any.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [folder, files] = process.argv.slice(2);
const { AdcgsError, open: openClip } = await import(pathToFileURL(resolve(folder, 'adcgs.js')).href);
const wasm = readFileSync(join(folder, 'adcgs.wasm')), stream = readFileSync(join(files, 's.adcgs'));
const bytes = new Uint8Array(stream);
const open = (source, options = {}) => openClip(source, { wasm, ...options });
const native = (...options) =>
    execFileSync('./adcgs-dec', ['--quiet', '--md5', ...options], { encoding: 'utf8' }).trim().split('\n');

function check(condition, text) {
    if (!condition) {
        console.log(`FAILED: node: ${text}`);
        process.exitCode = 1;
    }
}

function same(got, expected, text) {
    const [a, b] = [got, expected].map(value => JSON.stringify(value));
    check(a === b, `${text}: ${a}, expected ${b}`);
}

/** A promise must reject with this code, and a text in its message. */
async function fails(act, code, text, title) {
    try {
        await act();
        check(false, `${title}: succeeds`);
    } catch (e) {
        const isRight = e instanceof AdcgsError && e.code === code && e.message.includes(text);
        check(isRight, `${title}: ${e.name} ${e.code}: ${e.message}`);
    }
}

async function frames() {
    const clip = await open(bytes), expected = native(join(files, 's.adcgs'));
    await clip.ready;
    const { timeStart, timeEnd, frameRate, cameras, bytes: sizes, truncated } = clip.info;
    same([clip.available, sizes.total, truncated, clip.complete], [timeEnd, bytes.length, false, true], 'a complete clip');
    for (const i of [0, 2])
        same(clip.frame('home', timeStart + i / frameRate).md5, expected[i], `frame ${i}`);
    const stored = native(join(files, 's.adcgs'), '--camera', '1', '--time', '0.1', '--size', '40x40')[0];
    for (const camera of [1, cameras[1].name, cameras[1], { ...cameras[1], name: '' }]) {
        const { width, height, data, md5 } = clip.frame(camera, 0.1, { width: 40, height: 40 });
        same([width, height, data.length, md5], [40, 40, 6400, stored], `the stored camera ${JSON.stringify(camera)}`);
    }
    const [a, b] = [0, 1].map(i => clip.frame({ position: [0, 6, 1 + i], target: [0, 0, 0], fov: 40, width: 32, height: 24 }, 0));
    check(a.width === 32 && a.height === 24 && a.md5 !== b.md5, 'a camera that looks at a target');
    for (const camera of ['nobody', 7, { position: [0, 0, NaN] }, { position: [0, 0] }, { ...cameras[0], camToWorld: [] },
                          { ...cameras[0], width: 0 }, { position: [1, 1, 1], target: [1, 1, 1] }, { ...cameras[0], fx: 0 }])
        await fails(() => clip.frame(camera, 0), 'USAGE', 'camera', `the camera ${JSON.stringify(camera)}`);
    clip.close();
    await fails(() => clip.splats(0), 'USAGE', 'closed', 'a closed clip');
}

/** The vertices of adcgs-dec --splats. */
function readPly(name) {
    const file = readFileSync(name), end = file.indexOf('end_header\n') + 11, header = file.subarray(0, end).toString();
    const count = Number(/element vertex (\d+)/.exec(header)[1]);
    const names = [...header.matchAll(/property float (\w+)/g)].map(match => match[1]);
    const numbers = new Float32Array(file.buffer.slice(file.byteOffset + end, file.byteOffset + end + 4 * count * names.length));
    const column = name => Array.from({ length: count }, (_, i) => numbers[i * names.length + names.indexOf(name)]);
    return { count, column };
}

async function splats() {
    const clip = await open(new Blob([bytes]));
    await clip.ready;
    const got = clip.splats(0.1), ply = readPly(join(files, 'splats.ply')), SH = 0.28209479177387814;
    same(got.count, ply.count, 'number of splats');
    const worst = (array, stride, names, from) => Math.max(...names.map((name, a) => ply.column(name).reduce((most, value, i) =>
        Math.max(most, Math.abs(array[stride * i + a] - from(value)) / Math.max(1e-2, Math.abs(from(value)))), 0)));
    for (const [name, array, stride, columns, from, most] of [
        ['positions', got.positions, 3, ['x', 'y', 'z'], x => x, 0],
        ['rotations', got.rotations, 4, ['rot_0', 'rot_1', 'rot_2', 'rot_3'], x => x, 0],
        ['scales', got.scales, 3, ['scale_0', 'scale_1', 'scale_2'], Math.exp, 1e-6],
        ['opacities', got.opacities, 1, ['opacity'], x => 1 / (1 + Math.exp(-x)), 1e-6],
        ['colors', got.colors, 3, ['f_dc_0', 'f_dc_1', 'f_dc_2'], x => 0.5 + SH * x, 1e-5]]) {
        same(array.length, stride * got.count, `length of ${name}`);
        const difference = worst(array, stride, columns, from);
        check(difference <= most, `${name} differ from adcgs-dec --splats by ${difference}`);
    }
}

/** A stream that gives pieces when it is asked to. */
function slowly(total = bytes.length) {
    let controller, cancelled = false;
    const source = new ReadableStream({ start(c) { controller = c; }, cancel() { cancelled = true; } });
    let at = 0;
    return { source, isCancelled: () => cancelled, end: () => controller.close(), fail: e => controller.error(e),
             give(n) { controller.enqueue(bytes.slice(at, at = Math.min(total, at + n))); } };
}

const later = () => new Promise(done => setTimeout(done, 100));

async function progressive() {
    const slow = slowly();
    slow.give(600);
    const clip = await open(slow.source); // the header is there, nothing to show yet
    same([clip.isPlayable, clip.available, clip.info.frameRate], [false, -Infinity, 30], 'a header');
    await fails(() => clip.frame('home', 0), 'USAGE', 'nothing to show', 'a frame before the first part');
    let grown = 0;
    clip.addEventListener('progress', () => { grown++; });
    for (let i = 0; i < 33; i++)
        slow.give(1000);
    await clip.playable;
    const part = clip.frame('home', 0).md5;
    slow.give(bytes.length);
    slow.end();
    await clip.ready;
    check(grown >= 2, `${grown} progress events`);
    check(part !== clip.frame('home', 0).md5, 'the first part is as good as the whole');
    same(clip.frame('home', 0).md5, native(join(files, 's.adcgs'))[0], 'the whole after the first part');
}

async function failures() {
    await fails(() => open(new Uint8Array(3000)), 'DATA', 'not an adcgs stream', 'zeros');
    await fails(() => open(new ArrayBuffer(0)), 'TRUNCATED', 'ends after 0 bytes', 'no bytes');
    await fails(() => open(12), 'USAGE', 'expected an address', 'a number as the source');
    await fails(() => open(bytes, { wasm: new Uint8Array(8) }), 'UNSUPPORTED', 'module', 'another module');
    await fails(() => open('http://127.0.0.1:9/s.adcgs'), 'IO', '127.0.0.1:9', 'a server that does not answer');
    await fails(() => open(new Response('', { status: 404, statusText: 'Not Found' })), 'IO', '404 Not Found', 'status 404');
    // Damage late in the stream: the part before it remains.
    const damaged = bytes.slice();
    damaged.fill(255, bytes.length - 500, bytes.length - 490);
    const clip = await open(damaged);
    await fails(() => clip.ready, 'DATA', '', 'a damaged stream');
    check(clip.frame('home', 0).data.length > 0 && clip.complete, 'the part before the damage');
    // A stream that ends early, and a connection that fails.
    const cut = await open(bytes.slice(0, bytes.length * 3 / 4));
    await cut.ready;
    check(cut.info.truncated && cut.frame('home', 0).data.length > 0, 'a stream that ends early');
    const slow = slowly();
    slow.give(bytes.length * 3 / 4);
    const broken = await open(slow.source);
    await broken.playable;
    slow.fail(new TypeError('network error'));
    await fails(() => broken.ready, 'IO', 'network error', 'a connection that fails');
    check(broken.frame('home', 0).data.length > 0, 'the part before the failure');
    // Many bytes after the end of the stream are not read.
    const long = slowly(), opened = await (long.give(bytes.length), open(long.source));
    await opened.ready;
    await later();
    check(long.isCancelled(), 'reading goes on after the end of the stream');
}

async function aborts() {
    const reason = new Error('enough'), early = new AbortController(), slow = slowly();
    early.abort(reason);
    const message = promise => promise.then(() => 'succeeds', e => e.message);
    same(await message(open(bytes, { signal: early.signal })), 'enough', 'an aborted signal');
    const late = new AbortController(), before = open(slow.source, { signal: late.signal });
    await later();
    late.abort(reason);
    same([await message(before), slow.isCancelled()], ['enough', true], 'an abort before the header');
    const other = slowly(), last = new AbortController();
    other.give(1000);
    const clip = await open(other.source, { signal: last.signal });
    last.abort(reason);
    same([await message(clip.ready), await message(clip.playable), other.isCancelled()], ['enough', 'enough', true],
         'an abort after the header');
    const third = slowly();
    third.give(1000);
    const closed = await open(third.source);
    closed.close();
    await later();
    same([third.isCancelled(), (await message(closed.ready)).includes('closed')], [true, true], 'close() while bytes arrive');
}

for (const part of [frames, splats, progressive, failures, aborts])
    await part().catch(e => check(false, `${part.name}: ${e.stack}`));
