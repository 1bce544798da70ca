// SPDX-License-Identifier: BSD-2-Clause
// Input: the user's actions change the player's state. Output: the state is shown.
'use strict';

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

const SLIDER_KEYS = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'Home', 'End', 'PageUp', 'PageDown'];

/** Whether the focused element needs this key itself. All other keys work wherever the focus is. */
function isForElement({ target, key }) {
    if (!target.closest)
        return false;
    return target.id === 'time' ? SLIDER_KEYS.includes(key)
                                : [' ', 'Enter'].includes(key) && target.closest('button, summary') !== null;
}

function onKey(event, down) {
    const key = KEYS[event.key] || (event.key.length === 1 ? event.key.toLowerCase().charCodeAt(0) : 0);
    if (down)
        active = performance.now();
    if (!key || !opened() || event.ctrlKey || event.metaKey || event.altKey || isForElement(event))
        return;
    if (event.key === 'k' || event.key === 'v' || (event.key === 'q' && !view.call.view_flying())) // keys for windows only
        return;
    if (key === KEYS.Escape && down && closePanels()) {
        event.preventDefault();
        return;
    }
    if (key === KEYS.Escape && !view.call.view_flying())
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
    return !event.target.closest('#empty, #failure, #begin, #bar, .panel');
}

function onDown(event) {
    active = performance.now();
    if (!isOnPicture(event) || closePanels())
        return;
    hideHint();
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
    active = performance.now();
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

// ---- The state is shown. ----

const IDLE_MS = 2500;
let active = 0;                 // time of the last input
let seconds = '';

/** The controls fade while it plays and there is no input. */
function showIdle() {
    const bar = $('bar'), busy = performance.now() - active < IDLE_MS || bar.matches(':hover') || bar.querySelector(':focus-visible');
    $('stage').classList.toggle('idle', page.fades && !busy && page.playing && document.querySelector('.panel:not([hidden])') === null);
}

function showTime() {
    const call = view.call, bar = $('time'), most = Math.max(1, call.view_frames() - 1), total = page.duration;
    bar.max = call.view_frames() - 1;
    bar.value = call.view_frame();
    bar.style.setProperty('--part', `${100 * call.view_frame() / most}%`);
    const text = `${call.view_time().toFixed(2)}${isFinite(total) && total > 0 ? ` / ${page.facts.time_end.toFixed(2)}` : ''} s`;
    if (text === seconds)
        return;
    seconds = text;
    bar.setAttribute('aria-valuetext', `${call.view_time().toFixed(2)} seconds`);
    $('clock').textContent = `${text}${call.view_waits() ? ' …' : ''}`;
}

function showControls() {
    if (!opened())
        return;
    const call = view.call;
    showTime();
    $('play').setAttribute('aria-pressed', call.view_playing() === 1);
    $('play').disabled = $('time').disabled = call.view_frames() < 2;
    $('loop').setAttribute('aria-pressed', call.view_loop() === 1);
    $('fly').setAttribute('aria-pressed', call.view_flying() === 1);
    $('bar').hidden = $('stick').hidden = !call.view_bar();
    $('stick').classList.toggle('flying', call.view_flying() === 1);
    if (call.view_help() && $('help').hidden)
        showPanel('facts', false);
    showPanel('help', call.view_help() === 1);
    $('statistics').hidden = !call.view_statistics();
    if (call.view_statistics())
        $('statistics').textContent = statisticsText();
    if (!call.view_flying() && document.pointerLockElement)
        document.exitPointerLock();
    showMessage();
    showIdle();
    emitClock();
}

/** Where the page may not fill the screen, a frame opens it alone; a page that is alone has no button. */
function toggleFull() {
    if (document.fullscreenElement)
        document.exitFullscreen();
    else if (document.fullscreenEnabled)
        document.documentElement.requestFullscreen().catch(() => null);
    else
        window.open(location.href, '_blank', 'noopener');
}

function listenToPointer(stage) {
    stage.addEventListener('pointerdown', onDown);
    stage.addEventListener('pointermove', onMove);
    stage.addEventListener('pointerup', onUp);
    stage.addEventListener('pointercancel', onUp);
    stage.addEventListener('contextmenu', event => { if (isOnPicture(event)) event.preventDefault(); });
    stage.addEventListener('wheel', event => {
        if (!isOnPicture(event))
            return;
        event.preventDefault();
        active = performance.now();
        hideHint();
        send(WHEEL, { dy: -event.deltaY / (event.deltaMode ? 3 : WHEEL_STEP) });
    }, { passive: false });
}

function listenToButtons() {
    $('file').addEventListener('change', event => openFile(event.target.files[0]));
    document.querySelectorAll('.open').forEach(button => button.addEventListener('click', () => $('file').click()));
    $('again').addEventListener('click', () => lastSource());
    $('time').addEventListener('input', event => {
        view.call.view_tick(performance.now() / 1000);
        view.call.view_seek(event.target.value / Math.max(1, event.target.max));
        wake();
    });
    for (const [id, key] of [['play', ' '], ['loop', 'l'], ['reset', 'r'], ['fly', 'f'], ['shot', 'p'], ['keys', 'h']])
        $(id).addEventListener('click', () => { press(key.charCodeAt(0)); });
    $('more').addEventListener('click', toggleFacts);
    $('full').hidden = !document.fullscreenEnabled && parent === window;
    $('full').addEventListener('click', toggleFull);
    document.addEventListener('fullscreenchange', () =>
        $('full').setAttribute('aria-pressed', document.fullscreenElement !== null));
}

function listen() {
    const stage = $('stage');
    active = performance.now();
    window.addEventListener('keydown', event => onKey(event, true));
    window.addEventListener('keyup', event => onKey(event, false));
    window.addEventListener('blur', () => send(LOST));
    window.addEventListener('focusin', () => { active = performance.now(); });
    window.addEventListener('dragover', event => { event.preventDefault(); stage.classList.add('over'); });
    window.addEventListener('dragleave', () => stage.classList.remove('over'));
    window.addEventListener('drop', onDrop);
    listenToPointer(stage);
    listenToButtons();
    makeHelp();
    new ResizeObserver(wake).observe(stage);
    $('exact').setAttribute('aria-label', document.title);
}
