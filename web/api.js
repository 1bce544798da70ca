// SPDX-License-Identifier: BSD-2-Clause
// The page's interface for scripts: window.adcgs, and messages from the page that embeds this one in a frame. The man page of
// adcgs-share documents it.
'use strict';

const listeners = new Map();    // event: set of functions
const FLOAT64 = 8, POSE = 40;   // bytes in adcgs_camera: cam_to_world

function emit(event, detail = {}) {
    for (const listener of listeners.get(event) || [])
        listener(detail);
}

function needScene() {
    if (!opened())
        throw new Error('no scene yet: wait for "ready"');
}

function setPlaying(playing) {
    if (playing && page.begin)
        page.begin();
    if (!opened())
        wishes.autoplay = playing;
    else if (Boolean(view.call.view_playing()) !== playing)
        press(' '.charCodeAt(0));
}

/** The bytes of the current camera, moved to a position, with a target in the middle of its image. */
function cameraLookingAt({ position, target, up }) {
    const camera = cameraOf(1), numbers = new DataView(camera.buffer), at = i => POSE + i * FLOAT64;
    const upright = up || [1, 5, 9].map(i => -numbers.getFloat64(at(i), true));
    const pose = poseLookingAt(position, target, upright, () => {
        throw new TypeError('setCamera: position and target need three finite numbers each, and a distance');
    });
    pose.forEach((value, i) => numbers.setFloat64(at(i), value, true));
    camera.fill(0, CAMERA_NAME);
    return camera;
}

const commands = {
    play: () => setPlaying(true),
    pause: () => setPlaying(false),
    setMuted: muted => setMuted(Boolean(muted)),
    seek(seconds) {
        needScene();
        if (!isFinite(seconds))
            throw new TypeError('seek: expected seconds');
        seekTo(Number(seconds));
    },
    /** camera: name or index of a stored one, 'home', 'follow', or { position, target, up }. */
    setCamera(camera) {
        needScene();
        if (camera === 'home') {
            press('r'.charCodeAt(0));
            return;
        }
        if (camera === 'follow') {
            if (view.call.view_following() !== 1)
                press('c'.charCodeAt(0));
            return;
        }
        const index = typeof camera === 'object' && camera ? -1 : storedIndex(camera);
        if (index < 0 && (typeof camera !== 'object' || !camera))
            throw new RangeError(`setCamera: no camera ${camera}`);
        const bytes = index < 0 ? cameraLookingAt(camera) : storedCamera(index);
        view.call.view_tick(performance.now() / 1000);
        view.with([bytes], at => view.call.view_place(at));
        wake();
    },
};

/** Calls listener(detail) at each event: ready, frame, play, pause, end, error. Returns a function that ends this. */
function on(event, listener) {
    if (!listeners.has(event))
        listeners.set(event, new Set());
    listeners.get(event).add(listener);
    return () => listeners.get(event).delete(listener);
}

Object.assign(page, commands, { on });
Object.defineProperties(page, Object.getOwnPropertyDescriptors({
    get time() { return opened() ? view.call.view_time() : 0; },
    get duration() { return page.facts ? page.facts.time_end - page.facts.time_start : 0; },
    get playing() { return Boolean(opened() && view.call.view_playing()); },
    get muted() { return !sound || sound.muted; },
    get cameras() { return storedNames(); },
}));

// ---- Frames. ----

/** The embedding page sends { adcgs: 'play' }, { adcgs: 'seek', value: 1.5 }, { adcgs: 'on', value: 'frame' }. */
function onCommand(event) {
    const message = event.data;
    if (event.source !== parent || !message || typeof message !== 'object' || typeof message.adcgs !== 'string')
        return;
    const reply = detail => parent.postMessage(detail, event.origin === 'null' ? '*' : event.origin);
    try {
        if (message.adcgs === 'on')
            on(String(message.value), detail => reply({ adcgs: String(message.value), ...detail }));
        else if (Object.hasOwn(commands, message.adcgs))
            commands[message.adcgs](message.value);
    } catch (e) {
        reply({ adcgs: 'error', message: e.message });
    }
}

if (parent !== window) {
    window.addEventListener('message', onCommand);
    on('ready', detail => parent.postMessage({ adcgs: 'ready', ...detail }, '*'));
}

/** Report changes of the clock. */
let wasPlaying = false;
function emitClock() {
    const playing = page.playing;
    if (playing === wasPlaying)
        return;
    wasPlaying = playing;
    emit(playing ? 'play' : 'pause', { time: page.time });
    if (!playing && !view.call.view_loop() && view.call.view_frame() === view.call.view_frames() - 1)
        emit('end', { time: page.time });
}
