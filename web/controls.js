// SPDX-License-Identifier: BSD-2-Clause
// Input: the user's actions change the player's state. Output: the state is shown.
'use strict';

const KEYS = { Escape: 27, ArrowLeft: 256, ArrowRight: 257, Home: 258, End: 259, PageUp: 260, PageDown: 261, F1: 262,
               Shift: 263 };
const KEY = 2, BUTTON = 3, MOTION = 4, WHEEL = 5, LOST = 7; // src/play/event.h
const WHEEL_STEP = 100;                                     // pixels that browsers scroll per notch
const ZOOM_STEP = 0.9;                                      // src/camera/orbit_control.c

function opened() {
    return information && information.home;
}

function send(kind, e = {}) {
    if (!opened())
        return;
    view.call.view_tick(performance.now() / 1000);
    view.call.view_event(kind, e.key || 0, e.down ? 1 : 0, e.again ? 1 : 0, e.button || 0, e.x || 0, e.y || 0, e.dx || 0,
                         e.dy || 0);
    wake();
}

function press(key) {
    send(KEY, { key, down: true });
    send(KEY, { key, down: false });
}

function onKey(event, down) {
    const key = KEYS[event.key] || (event.key.length === 1 ? event.key.toLowerCase().charCodeAt(0) : 0);
    const elsewhere = event.target.tagName === 'INPUT' || (event.target.tagName === 'BUTTON' && event.key === ' ');
    if (!key || !opened() || event.ctrlKey || event.metaKey || event.altKey || elsewhere)
        return;
    if (event.key === 'k' || event.key === 'v' || (event.key === 'q' && !view.call.view_flying())) // keys for windows only
        return;
    if (key === KEYS.Escape && !view.call.view_help() && !view.call.view_flying())
        return;
    const layers = view.call.view_layers();
    send(KEY, { key, down, again: event.repeat });
    if (layers !== view.call.view_layers())
        worker.postMessage({ kind: 'layers', layers: view.call.view_layers() });
    event.preventDefault();
}

// ---- Mouse and fingers. ----

const pointers = new Map();

/** Midpoint and distance of two fingers. */
function pinchOf() {
    const [a, b] = [...pointers.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, distance: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) };
}

function placeOf(event) {
    const box = $('stage').getBoundingClientRect(), dense = window.devicePixelRatio || 1;
    return { x: (event.clientX - box.left) * dense, y: (event.clientY - box.top) * dense };
}

/** Whether an event is on the image, not on an element over it. */
function isOnPicture(event) {
    return !event.target.closest('#empty, #facts, #help');
}

function onDown(event) {
    if (!isOnPicture(event))
        return;
    const at = placeOf(event);
    $('stage').setPointerCapture(event.pointerId);
    $('exact').focus({ preventScroll: true });
    pointers.set(event.pointerId, at);
    if (pointers.size === 1)
        send(BUTTON, { ...at, down: true, button: event.button === 2 ? 3 : event.button === 1 ? 2 : 1 });
    else
        send(BUTTON, { ...at, down: false, button: 1 });
    if (opened() && view.call.view_flying() && event.pointerType === 'mouse' && $('stage').requestPointerLock)
        $('stage').requestPointerLock();
}

function onMove(event) {
    const dense = window.devicePixelRatio || 1, before = pointers.get(event.pointerId), at = placeOf(event);
    if (document.pointerLockElement)
        send(MOTION, { ...at, dx: event.movementX * dense, dy: event.movementY * dense });
    if (document.pointerLockElement || !before)
        return;
    const pinch = pointers.size === 2 && pinchOf();
    pointers.set(event.pointerId, at);
    if (pointers.size === 1)
        send(MOTION, { ...at, dx: at.x - before.x, dy: at.y - before.y });
    else if (pinch && opened()) {
        const now = pinchOf();
        view.call.view_tick(performance.now() / 1000);
        view.call.view_pinch(now.x - pinch.x, now.y - pinch.y, Math.log(pinch.distance / now.distance) / Math.log(ZOOM_STEP));
        wake();
    }
}

function onUp(event) {
    pointers.delete(event.pointerId);
    send(BUTTON, { ...placeOf(event), down: false, button: 1 });
}

function onDrop(event) {
    event.preventDefault();
    $('stage').classList.remove('over');
    openFile(event.dataTransfer.files[0]);
}

function openFile(file) {
    if (file)
        openScene(async () => ({ name: file.name, stream: file.stream(), total: file.size }));
}

// ---- Texts next to the image. ----

function showHelp() {
    const lines = view.text(view.call.view_help_lines()).trim().split('\n').map(line => line.split('\t'));
    const table = element('table');
    const touch = [['one finger', 'orbit'], ['two fingers', 'pan, zoom']];
    for (const [keys, text] of lines.concat(touch))
        rowOf(table, '', element('td', keys), element('td', keys === 'p' ? 'screenshot' : text));
    table.querySelectorAll('th').forEach(cell => cell.remove());
    $('help').replaceChildren(table);
}

function statisticsText() {
    const call = view.call, drawn = page.drawn, fast = page.fast;
    const ms = value => (value || 0).toFixed(1);
    const threads = drawn ? drawn.threads : 1;
    return [`module  ${page.module}, ${threads} thread${threads > 1 ? 's' : ''}`,
            `exact   ${drawn ? `${ms(drawn.ms)} ms, ${drawn.width}x${drawn.height}` : '-'}`,
            gpu ? `gpu     pack ${ms(fast.packMs)}, sort ${ms(fast.sortMs)}, draw ${ms(fast.drawMs)} ms` : 'gpu     none',
            `splats  ${fast.n || page.facts.gaussians}`,
            `layers  ${call.view_layers()}`,
            `time    ${call.view_time().toFixed(3)} s, frame ${call.view_frame()} of ${call.view_frames()}`,
            `speed   ${call.view_factor()}x${call.view_loop() ? ', loop' : ''}${call.view_flying() ? ', flying' : ''}`,
            `bytes   ${information.received}${page.total ? ` of ${page.total}` : ''}`,
            `first   ${page.first.toFixed(0)} ms`].join('\n');
}

let messageTimer = 0;
function showMessage() {
    const text = view.text(view.call.view_message());
    if (text && text !== page.message)
        say(text);
    clearTimeout(messageTimer);
    if (text)
        messageTimer = setTimeout(() => { say(''); wake(); }, 3000);
}

function showControls() {
    const open = opened();
    for (const id of ['play', 'time', 'loop', 'reset', 'fly', 'shot', 'more', 'keys'])
        $(id).disabled = !open;
    if (!open)
        return;
    const call = view.call;
    $('time').max = call.view_frames() - 1;
    $('time').value = call.view_frame();
    $('clock').textContent = `${call.view_time().toFixed(2)} s${call.view_waits() ? ' …' : ''}`;
    $('play').textContent = call.view_playing() ? '❚❚' : '▶';
    $('loop').setAttribute('aria-pressed', call.view_loop() === 1);
    $('fly').setAttribute('aria-pressed', call.view_flying() === 1);
    $('bar').hidden = !call.view_bar();
    $('help').hidden = !call.view_help();
    $('statistics').hidden = !call.view_statistics();
    if (call.view_statistics())
        $('statistics').textContent = statisticsText();
    if (!call.view_flying() && document.pointerLockElement)
        document.exitPointerLock();
    showMessage();
}

function listen() {
    const stage = $('stage');
    showHelp();
    showControls();
    window.addEventListener('keydown', event => onKey(event, true));
    window.addEventListener('keyup', event => onKey(event, false));
    window.addEventListener('blur', () => send(LOST));
    window.addEventListener('dragover', event => { event.preventDefault(); stage.classList.add('over'); });
    window.addEventListener('dragleave', () => stage.classList.remove('over'));
    window.addEventListener('drop', onDrop);
    stage.addEventListener('pointerdown', onDown);
    stage.addEventListener('pointermove', onMove);
    stage.addEventListener('pointerup', onUp);
    stage.addEventListener('pointercancel', onUp);
    stage.addEventListener('contextmenu', event => event.preventDefault());
    stage.addEventListener('wheel', event => {
        if (!isOnPicture(event))
            return;
        event.preventDefault();
        send(WHEEL, { dy: -event.deltaY / (event.deltaMode ? 3 : WHEEL_STEP) });
    }, { passive: false });
    new ResizeObserver(wake).observe(stage);
    $('file').addEventListener('change', event => openFile(event.target.files[0]));
    $('time').addEventListener('input', event => {
        view.call.view_tick(performance.now() / 1000);
        view.call.view_seek(event.target.value / Math.max(1, event.target.max));
        wake();
    });
    for (const [id, key] of [['play', ' '], ['loop', 'l'], ['reset', 'r'], ['fly', 'f'], ['shot', 'p'], ['keys', 'h']])
        $(id).addEventListener('click', () => { press(key.charCodeAt(0)); });
    $('more').addEventListener('click', () => { $('facts').hidden = !$('facts').hidden; });
    $('full').addEventListener('click', () => document.fullscreenElement ? document.exitFullscreen()
                                                                         : document.documentElement.requestFullscreen());
}
