// SPDX-License-Identifier: BSD-2-Clause
// The worker: decodes incoming bytes, renders exact frames, packs and sorts splats for the GPU. It handles messages in order.
'use strict';

let modules, engine, which;
let threads = 1;                 // maximum number of rendering threads
let pieces = [], received = 0;   // the stream, for opening it again
let number = 0, taken = 0;       // of the scene; its bytes received, including those not kept
let enough = false;              // more bytes are useless: the stream has ended or is as long as its level allows
let ended = false, failed = null; // no more bytes will come; the message of the decoder when it failed
let drawable = false;
let order = null;                // promise that makes each message wait for the previous one

async function useModule(but) {
    which = chooseModule(modules, but);
    if (!which)
        throw new Error(but ? 'the arithmetic of this browser’s WebAssembly does not follow the specification'
                            : 'this browser has no WebAssembly with SIMD');
    engine = await Engine.create(modules[which], threads > 1);
    startHelpers(engine, threads);
    return engine.call.page_open();
}

/** Start the module that computes exactly. If the faster one does not fuse, start again with the other one. */
async function begin() {
    let status = await useModule(null);
    if (status === ERR_FPENV && which === 'relaxed')
        status = await useModule('relaxed');
    if (status !== OK)
        throw new Error(engine.text(engine.call.page_error()));
    postMessage({ kind: 'ready', module: which });
}

function whole() {
    const all = new Uint8Array(received);
    let at = 0;
    for (const piece of pieces) {
        all.set(piece, at);
        at += piece.length;
    }
    pieces = [all];
    return all;
}

function factsNow() {
    return JSON.parse(engine.text(engine.call.page_facts()) || 'null');
}

/** Report the current knowledge to the page. */
function report(arrived) {
    const call = engine.call, at = call.page_info();
    const message = { kind: 'grown', arrived, received, ended, drawable, failed, fault: engine.text(call.page_fault()) };
    if (at) {
        message.info = engine.copy(at, call.page_info_size());
        message.facts = factsNow();
        const cameras = call.page_cameras(), home = drawable ? call.page_home() : 0;
        if (cameras && home) {
            message.cameras = engine.copy(cameras, message.facts.cameras * call.page_filmed_size());
            message.home = engine.copy(home, call.page_camera_size());
            message.filter = call.page_filter();
        }
    }
    postMessage(message);
}

function push(bytes) {
    return engine.with([bytes], at => engine.call.page_push(at, bytes.length));
}

/** Give bytes to the decoder, unless it failed before. Returns an arrival, or a negative status. */
function decode(bytes) {
    if (failed)
        return 0;
    const arrived = push(bytes);
    if (arrived < 0)
        failed = engine.text(engine.call.page_error());
    drawable = drawable || arrived >= ARRIVED_SEGMENT;
    if (arrived !== 0)
        report(arrived);
    return arrived;
}

/** Keep all useful bytes, in case the stream is damaged and must be opened again as a whole. */
function take(bytes) {
    taken += bytes.length;
    if (!enough) {
        pieces.push(bytes);
        received += bytes.length;
        enough = decode(bytes) === ARRIVED_END || received >= engine.call.page_useful();
    }
    postMessage({ kind: 'taken', number, taken, enough });
}

/** All bytes have arrived. Show the intact parts of a damaged stream. */
function end() {
    ended = true;
    if (!failed && engine.call.page_end() !== OK)
        failed = engine.text(engine.call.page_error());
    if (failed) {
        const all = whole();
        if (engine.with([all], at => engine.call.page_reopen(at, all.length, 0, 1)) === OK)
            drawable = true;
    } else if (!drawable) {
        const facts = factsNow(); // at the end, a part of a segment may become a segment
        drawable = facts !== null && facts.segments > 0;
    }
    report(0);
}

/** Load the same bytes in the other module, once the faster one turns out not to fuse. */
async function fallBack() {
    if (which !== 'relaxed' || await useModule('relaxed') !== OK)
        return false;
    const all = whole();
    push(all);
    if (ended)
        end();
    postMessage({ kind: 'ready', module: which });
    return true;
}

async function draw(m) {
    const call = engine.call, start = performance.now();
    let status = engine.with([m.camera], at => call.page_draw(at, m.time, m.tiers, m.digest ? 1 : 0));
    if (status === ERR_FPENV && await fallBack())
        return draw(m);
    const reply = { kind: 'drawn', id: m.id, time: m.time, status, exact: m.exact, saves: m.saves };
    reply.threads = 1 + call.page_helpers();
    const size = new DataView(m.camera.buffer, m.camera.byteOffset);
    reply.width = size.getInt32(CAMERA.WIDTH, true);
    reply.height = size.getInt32(CAMERA.HEIGHT, true);
    if (status === OK) {
        reply.pixels = engine.copy(call.page_pixels(), 4 * reply.width * reply.height).buffer;
        reply.digest = engine.text(call.page_digest());
    } else {
        reply.error = engine.text(call.page_error());
    }
    reply.ms = performance.now() - start;
    postMessage(reply, reply.pixels ? [reply.pixels] : []);
}

/** Answer a request for the point under a place of the image. */
function findPivot(m) {
    const at = drawable ? engine.with([m.camera], c => engine.call.page_pivot(c, m.time, m.x, m.y)) : 0;
    if (at)
        postMessage({ kind: 'pivot', number: m.number, scene: m.scene,
                      point: new Float64Array(engine.copy(at, 24).buffer) });
}

function sorted(d) {
    return engine.copy(engine.call.page_sort(d[0], d[1], d[2]), 4 * splats).buffer;
}

let splats = 0;
function pack(m) {
    const start = performance.now();
    splats = Math.max(0, engine.call.page_pack(m.time));
    const texels = splats ? engine.copy(engine.call.page_texels(), 64 * splats).buffer : new ArrayBuffer(0);
    const packed = performance.now(), indices = m.direction ? sorted(m.direction) : null; // WebGPU sorts by itself
    postMessage({ kind: 'splats', time: m.time, n: splats, texels, indices, packMs: packed - start,
                  sortMs: performance.now() - packed }, indices ? [texels, indices] : [texels]);
}

function sort(m) {
    const start = performance.now(), indices = sorted(m.direction);
    postMessage({ kind: 'sorted', n: splats, indices, sortMs: performance.now() - start }, [indices]);
}

function setLayers(m) {
    const all = whole();
    if (ended && engine.with([all], at => engine.call.page_reopen(at, all.length, m.layers, failed ? 1 : 0)) === OK)
        report(0);
}

async function handle(m) {
    switch (m.kind) {
    case 'help': await help(m); break;
    case 'modules':
        modules = m.modules;
        threads = threadsHere(m.threads);
        break;
    case 'open':
        pieces = [];
        number = m.number;
        received = taken = splats = 0;
        ended = drawable = enough = false;
        failed = null;
        await begin();
        break;
    case 'bytes': take(m.bytes); break;
    case 'end': end(); break;
    case 'draw': await draw(m); break;
    case 'pivot': findPivot(m); break;
    case 'splats': pack(m); break;
    case 'sort': sort(m); break;
    case 'layers': setLayers(m); break;
    }
}

onmessage = event => {
    order = Promise.resolve(order).then(() => handle(event.data)).catch(e => postMessage({ kind: 'broken', error: e.message }));
};
