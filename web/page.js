// SPDX-License-Identifier: BSD-2-Clause
// The page: receives a scene and renders it: with the GPU during motion, exactly when everything stands still.
'use strict';

const $ = id => document.getElementById(id);

/** State that tests and curious users may inspect. */
const page = window.adcgs = {
    state: 'empty',       // empty, loading, complete, failed
    module: null,         // the module that renders
    name: '', total: 0,
    facts: null, notes: [],
    picture: null,        // the last exact image: width, height, time, digest, ms
    pictures: 0,
    listing: false,       // check.js requests images: no others in the meantime
    opened: 0, first: 0,  // milliseconds: when a scene began to arrive, and the time until its first image
    fast: {},             // milliseconds for the last image of the GPU: pack, sort, draw
    get view() { return view; },
    get generation() { return generation; }, // of the scene's state; page.picture.generation is the rendered one
    get gpu() { return gpu; },
};

let worker, view, gpu = null;
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
}

function say(text) {
    page.message = text;
    $('message').textContent = text;
}

function fail(text) {
    setState('failed');
    say(text);
}

function note(text) {
    if (!page.notes.includes(text))
        page.notes.push(text);
}

// ---- Receiving a scene. ----

async function openScene(getSource) {
    const number = ++reading, ours = new Flow(AHEAD);
    flow.end();
    flow = ours;
    setState('loading');
    say('');
    information = null;
    shownKey = '';
    Object.assign(page, { name: '', total: 0, facts: null, picture: null, drawn: null, first: 0, opened: performance.now() });
    page.notes = page.notes.filter(text => !text.startsWith('file: '));
    worker.postMessage({ kind: 'open', number });
    try {
        const source = await getSource();
        Object.assign(page, { name: source.name, total: source.total || 0 });
        await readStream(source.stream, ours, bytes => {
            if (number === reading)
                worker.postMessage({ kind: 'bytes', bytes }, [bytes.buffer]);
        });
    } catch (e) {
        if (number === reading)
            note('file: ' + e.message);
    }
    if (number === reading)
        worker.postMessage({ kind: 'end' });
}

/** Take a report of the worker. The view gets copies of the data that the worker's instance found. */
function takeReport(report) {
    const first = information === null || !information.home;
    information = report;
    page.facts = report.facts || null;
    generation++;
    if (report.home) {
        const over = report.ended ? 1 : 0, { info, home, cameras } = report;
        if (first)
            view.with([info, home, cameras], (i, h, c) => view.call.view_open(i, h, c, over));
        else
            view.with([info], i => view.call.view_span(i, over));
    }
    if (report.ended)
        finish(report);
    $('empty').hidden = true;
    showControls();
    if (page.facts)
        showFacts($('facts'), page.name, page.facts, page.notes);
    wake();
}

function finish(report) {
    if (report.failed)
        note('file: ' + report.failed);
    if (report.fault && report.fault !== report.failed)
        note('file: ' + report.fault);
    const wrong = page.notes.filter(text => text.startsWith('file: ')).map(text => text.slice(6));
    if (!report.drawable)
        fail(`${page.name || 'stream'}: ${wrong[0] || 'ends before anything can be rendered'}`);
    else if (report.failed || (report.facts && report.facts.faults))
        say(`${page.name}: damaged; showing the intact parts (${wrong[0]})`);
    else if (report.facts && report.facts.truncated)
        say(`${page.name}: ends early; showing the complete part`);
    if (report.drawable)
        setState('complete');
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

/** Render the current view with the GPU, from the splats packed last. */
function drawFast() {
    const start = performance.now(), time = view.call.view_time(), direction = directionOf(cameraOf(1));
    const turned = direction.some((d, i) => Math.abs(d - packed.direction[i]) > 1e-4);
    if (!packing && (packed.time !== time || packed.generation !== generation)) {
        packing = true;
        packed = { time, generation, direction };
        worker.postMessage({ kind: 'splats', time, direction });
    } else if (!packing && turned) {
        packing = true;
        packed.direction = direction;
        worker.postMessage({ kind: 'sort', direction });
    }
    const uniforms = view.call.view_uniforms();
    if (!gpu.n || !uniforms)
        return;
    const camera = new DataView(cameraOf(1).buffer);
    gpu.draw(view.floats(uniforms, 21), camera.getInt32(CAMERA.WIDTH, true), camera.getInt32(CAMERA.HEIGHT, true),
             page.facts.background, information.filter);
    page.fast.drawMs = performance.now() - start;
    $('fast').hidden = false;
    $('exact').style.opacity = 0;
    $('what').textContent = `moving ${gpu.canvas.width}×${gpu.canvas.height}, by WebGL2: not exact`;
    $('digest').textContent = '';
    shownKey = '';
}

function wake() {
    if (asked)
        return;
    asked = true;
    requestAnimationFrame(step);
}

function step() {
    asked = false;
    if (!information || !information.home)
        return;
    view.call.view_tick(performance.now() / 1000);
    fitCanvas();
    const moving = view.call.view_moving() && !saves;
    if (gpu && gpu.lost)
        dropGpu('WebGL2 was lost');
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

function dropGpu(why) {
    gpu = null;
    $('fast').hidden = true;
    note(`${why}: moving images are rendered exactly, and smaller if that takes long`);
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
    page.first = page.first || performance.now() - page.opened;
    if (m.exact)
        page.picture = { width: m.width, height: m.height, time: m.time, digest: m.digest, ms: m.ms, generation: m.id };
    else
        view.call.view_took(m.ms / 1000);
    page.drawn = { width: m.width, height: m.height, ms: m.ms, exact: m.exact, threads: m.threads };
    $('digest').textContent = m.digest;
    $('what').textContent = `${m.exact ? 'exact' : 'moving'} ${m.width}×${m.height}, ${m.time.toFixed(3)} s, ` +
        `${m.ms.toFixed(0)} ms by the ${page.module} module${m.digest ? '; MD5' : ''}`;
    if (m.saves)
        download();
    wake();
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
    if (!gpu)
        return;
    if (m.texels)
        gpu.take(m.texels, m.n);
    if (m.n === gpu.n)
        gpu.sort(m.indices);
    page.fast = { ...page.fast, n: m.n, packMs: m.packMs || page.fast.packMs, sortMs: m.sortMs };
    wake();
}

function onReply(m) {
    switch (m.kind) {
    case 'ready': page.module = m.module; break;
    case 'grown': takeReport(m); break;
    case 'drawn': takePicture(m); break;
    case 'splats':
    case 'sorted': takeSplats(m); break;
    case 'taken':
        if (m.number === reading)
            flow.take(m.taken);
        if (m.number === reading && m.enough)
            flow.end();
        break;
    case 'broken':
        flow.end();
        fail(m.error);
        break;
    }
}

// ---- Start. ----

async function start() {
    const modules = { relaxed: await unpack('relaxed'), exact: await unpack('exact-module') };
    const which = chooseModule(modules, null);
    if (!which)
        throw new Error('this browser has no WebAssembly with SIMD: nothing can be rendered');
    if (which === 'exact')
        note('no relaxed SIMD: the exact module renders, about five times slower');
    view = await Engine.create(modules[which]);
    worker = new Worker(URL.createObjectURL(new Blob([$('worker-text').textContent], { type: 'text/javascript' })));
    worker.onmessage = event => onReply(event.data);
    worker.onerror = event => fail(`worker: ${event.message}`);
    const parameters = new URLSearchParams(location.search);
    if (parameters.get('module') === 'exact')
        delete modules.relaxed;
    worker.postMessage({ kind: 'modules', modules, threads: Number(parameters.get('threads')) });
    try {
        if (parameters.get('draw') === 'exact')
            throw new Error('draw=exact');
        gpu = new Gpu($('fast'));
    } catch (e) {
        dropGpu(e.message);
    }
    listen();
    const embedded = embeddedScene(), source = parameters.get('src');
    if (source)
        openScene(() => sceneAt(source));
    else if (embedded)
        openScene(async () => embedded);
    if (parameters.has('md5'))
        listDigests(Number(parameters.get('md5')) || 1);
}

window.addEventListener('DOMContentLoaded', () => start().catch(e => fail(e.message)));
