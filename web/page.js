// SPDX-License-Identifier: BSD-2-Clause
// The page: receives a scene and renders it: with the GPU during motion, exactly when everything stands still.
'use strict';

const $ = id => document.getElementById(id);

/** State that tests and curious users may inspect. */
const page = window.adcgs = {
    state: 'empty',       // empty, waiting, loading, complete, failed
    module: null,         // the module that renders
    name: '', total: 0,
    facts: null, notes: [],
    picture: null,        // the last exact image: width, height, time, digest, ms
    pictures: 0,
    listing: false,       // check.js requests images: no others in the meantime
    opened: 0, first: 0,  // milliseconds: when a scene began to arrive, and the time until its first image
    fast: {},             // milliseconds for the last image of the GPU: pack, sort, draw, and until it was there
    divider: 1,           // of the size of the GPU's images
    adaptive: true,       // whether the divider follows the GPU's speed
    fades: true,          // whether the controls disappear while it plays
    get view() { return view; },
    get generation() { return generation; }, // of the scene's state; that of the last image is in page.picture
    get gpu() { return gpu; },
    get gpuKind() { return gpu ? gpu.kind : 'none'; }, // webgpu, webgl2, none
    gpuChosen: null,      // a promise: after it, no other kind takes its place unless one is lost or slow
    get sound() { return sound; },
    get headset() { return headset; },
    offerHeadset: () => offerHeadset(),
};

let worker, view;
let gpu = null, webgl = null, webgpu = null; // the one in use: WebGPU where it is there, else WebGL2
const AHEAD = 8388608;          // maximum bytes of a scene on their way to the worker
let reading = 0;                // number of the scene being read; pieces of others are dropped
let flow = new Flow(AHEAD);     // of its bytes
let information = null;         // the last report of the worker
let generation = 0;             // counts changes of the scene's content
let shownKey = '', asked = false, drawing = false, packing = false;
let saves = false;              // a screenshot is wanted
let packed = { time: null, generation: -1, direction: [0, 0, 0] };

function setState(state) {
    page.state = document.documentElement.dataset.state = state;
    $('stage').classList.toggle('failed', state === 'failed');
}

function note(text) {
    if (!page.notes.includes(text))
        page.notes.push(text);
}

// ---- Requesting images. ----

function fitCanvas() {
    const stage = $('stage'), dense = window.devicePixelRatio || 1;
    const pixels = length => Math.max(1, Math.round(length * dense));
    view.call.view_resize(pixels(stage.clientWidth), pixels(stage.clientHeight), dense);
}

function cameraOf(divider) {
    return view.copy(view.call.view_camera(divider), view.call.page_camera_size());
}

function directionOf(camera) {
    const numbers = new DataView(camera.buffer);
    return CAMERA.FORWARD.map(at => numbers.getFloat64(at, true));
}

function ask(exact) {
    const divider = exact ? 1 : view.call.view_divider(), camera = cameraOf(divider), time = view.call.view_time();
    const key = [generation, time, exact, divider, camera.subarray(0, 144).join()].join();
    if (drawing || page.listing || (key === shownKey && !saves))
        return;
    drawing = true;
    shownKey = key;
    worker.postMessage({ kind: 'draw', id: generation,
                         camera, time, tiers: exact ? 0 : view.call.view_tiers(), digest: exact, exact, saves });
}

const SLOW_MS = 100, QUICK_MS = 25, DIVIDER_MOST = 3; // of images of the GPU

/** An image that takes long makes the next ones smaller: a half of the width takes a fourth of the time. */
function adapt() {
    if (page.adaptive && gpu.took > SLOW_MS)
        page.divider = Math.min(page.divider + 1, DIVIDER_MOST);
    else if (page.adaptive && gpu.took && gpu.took < QUICK_MS)
        page.divider = Math.max(page.divider - 1, 1);
    page.fast.tookMs = gpu.took || page.fast.tookMs;
    gpu.took = 0;
}

/** Request the splats of a time, and their order for a direction of view, unless the GPU sorts. */
function requestSplats(time, direction = directionOf(cameraOf(1))) {
    const turned = !gpu.sorts && direction.some((d, i) => Math.abs(d - packed.direction[i]) > 1e-4);
    if (!packing && (packed.time !== time || packed.generation !== generation)) {
        packing = true;
        packed = { time, generation, direction };
        worker.postMessage({ kind: 'splats', time, direction: gpu.sorts ? null : direction });
    } else if (!packing && turned) {
        packing = true;
        packed.direction = direction;
        worker.postMessage({ kind: 'sort', direction });
    }
}

/** Render the current view with the GPU, from the splats packed last, unless it still renders the previous image. */
function drawFast() {
    const start = performance.now(), time = view.call.view_time();
    requestSplats(time);
    if (!gpu.n || gpu.busy())
        return;
    adapt();
    const camera = new DataView(cameraOf(page.divider).buffer), uniforms = view.call.view_uniforms(page.divider);
    if (!uniforms)
        return;
    gpu.draw(view.floats(uniforms, 21), camera.getInt32(CAMERA.WIDTH, true), camera.getInt32(CAMERA.HEIGHT, true),
             page.facts.background, information.filter);
    page.fast.drawMs = performance.now() - start;
    showCanvas();
    $('fast').hidden = false;
    $('exact').style.opacity = 0;
    $('what').textContent = `Moving image ${gpu.canvas.width} × ${gpu.canvas.height}, not exact`;
    $('digest').textContent = '';
    shownKey = '';
    showed(time, false);
}

/** The worker finds the point under a place of the image: the new centre of the orbit. */
function requestPivot() {
    const number = view.call.view_pivot_wanted();
    if (number)
        worker.postMessage({ kind: 'pivot', number, scene: reading, camera: cameraOf(1), time: view.call.view_time(),
                             x: view.call.view_pivot_at(0), y: view.call.view_pivot_at(1) });
}

function wake() {
    if (asked)
        return;
    asked = true;
    requestAnimationFrame(step);
}

function step() {
    asked = false;
    if (!information || !information.home || headset)
        return;
    view.call.view_tick(performance.now() / 1000);
    followSound();
    fitCanvas();
    requestPivot();
    styleLimits(view.call, [$('exact'), $('fast')]);
    explainEdge(view.call.view_outside());
    const moving = view.call.view_moving() && !saves;
    if (gpu && (gpu.lost || gpu.slow))
        chooseGpu();
    if (moving && gpu)
        drawFast();
    else
        ask(!moving);
    if (view.call.view_shot()) {
        saves = true;
        wake();
    }
    showControls();
    if (moving || view.call.view_playing())
        wake();
}

// ---- The GPU. ----

/** Without WebGPU, another WebGL2: the first one may be lost too, with the browser's process of the GPU. */
function renewWebgl() {
    webgpu = null;
    try {
        webgl = new Gpu($('fast').cloneNode());
    } catch (e) {
        webgl = null;
    }
}

/** WebGPU that is slower than WebGL2 may be is given up. */
function dropSlow() {
    webgpu.device.destroy();
    webgpu = null;
    note('WebGPU was slow');
}

/** WebGPU, else WebGL2, else none. A headset needs WebGL2. */
function chooseGpu() {
    if (gpu && gpu.slow && webgl && !webgl.lost)
        dropSlow();
    const last = gpu, lost = last && last.lost ? `${last.kind === 'webgpu' ? 'WebGPU' : 'WebGL2'} was lost` : '';
    if (webgpu && webgpu.lost && !headset)
        renewWebgl();
    gpu = [headset ? null : webgpu, webgl].find(one => one && !one.lost) || null;
    if (gpu === last)
        return;
    packed.time = null;
    if (gpu)
        gpu.n = 0; // until its splats arrive
    if (lost && gpu)
        note(lost);
    else if (lost)
        dropGpu(lost);
}

function dropGpu(why) {
    $('fast').hidden = true;
    note(`${why}: moving images are rendered exactly, and smaller if that takes long`);
}

/** A canvas belongs to one interface for ever. The one in use takes the other's place with its first image. */
function showCanvas() {
    const shown = $('fast');
    if (shown !== gpu.canvas) {
        gpu.canvas.style.cssText = shown.style.cssText;
        shown.replaceWith(gpu.canvas);
    }
}

/** wanted: webgpu, even in software; webgl2; none; null: WebGPU as soon as an adapter is there, until then WebGL2. */
async function startGpu(wanted) {
    let why = 'gpu=none';
    try {
        webgl = wanted === 'none' ? null : new Gpu($('fast'));
    } catch (e) {
        why = e.message;
    }
    chooseGpu();
    if (wanted !== 'none' && wanted !== 'webgl2')
        webgpu = await WebGpu.open($('fast').cloneNode(), wanted === 'webgpu').catch(e => {
            if (wanted === 'webgpu')
                note(e.message);
            return null;
        });
    chooseGpu();
    if (!gpu)
        dropGpu(why);
}

// ---- Showing images. ----

function takePicture(m) {
    drawing = false;
    if (m.status !== OK) {
        say(m.error);
        return;
    }
    const canvas = $('exact');
    canvas.width = m.width;
    canvas.height = m.height;
    canvas.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(m.pixels), m.width, m.height), 0, 0);
    canvas.style.opacity = 1;
    $('fast').hidden = true;
    page.pictures++;
    if (m.exact)
        page.picture = { width: m.width, height: m.height, time: m.time, digest: m.digest, ms: m.ms, generation: m.id };
    else
        view.call.view_took(m.ms / 1000);
    page.drawn = { width: m.width, height: m.height, ms: m.ms, exact: m.exact, threads: m.threads };
    $('digest').textContent = m.digest;
    $('what').textContent = `${m.exact ? 'Exact' : 'Moving'} image ${m.width} × ${m.height} at ${m.time.toFixed(3)} s` +
        `${m.digest ? ', MD5' : ''}`;
    showed(m.time, m.exact);
    if (m.saves)
        download();
    wake();
}

/** An image is visible: the first one replaces the poster. */
function showed(time, exact) {
    const stage = $('stage');
    page.first = page.first || performance.now() - page.opened;
    if (!stage.classList.contains('shown')) {
        stage.classList.add('shown');
        active = performance.now();
        showHint();
        emit('ready', { duration: page.duration, cameras: page.cameras, title: document.title });
    }
    emit('frame', { time, exact });
}

function download() {
    saves = false;
    const name = `${page.name.replace(/\.adcgs$/, '') || 'scene'}-${page.picture.time.toFixed(3)}.png`;
    $('exact').toBlob(blob => {
        const link = element('a');
        link.href = URL.createObjectURL(blob);
        link.download = name;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 10000);
        page.saved = { name, bytes: blob.size };
    });
    say(name);
}

function takeSplats(m) {
    packing = false;
    if (!gpu || (!gpu.sorts && !m.indices)) // the splats of WebGPU arrive without an order
        return wake();
    if (m.texels)
        gpu.take(m.texels, m.n);
    if (!gpu.sorts && m.n === gpu.n)
        gpu.sort(m.indices);
    page.fast = { ...page.fast, n: m.n, packMs: m.packMs || page.fast.packMs, sortMs: m.sortMs };
    return wake();
}

function onReply(m) {
    switch (m.kind) {
    case 'ready': page.module = m.module; break;
    case 'grown': takeReport(m); break;
    case 'drawn': takePicture(m); break;
    case 'pivot':
        if (m.scene === reading) {
            view.call.view_pivot(m.number, ...m.point);
            wake();
        }
        break;
    case 'splats':
    case 'sorted': takeSplats(m); break;
    case 'taken':
        if (m.number === reading) {
            flow.take(m.taken);
            showProgress(m.taken, page.total);
        }
        if (m.number === reading && m.enough)
            flow.end();
        break;
    case 'broken':
        flow.end();
        fail(m.error);
        break;
    }
}
