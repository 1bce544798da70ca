// SPDX-License-Identifier: BSD-2-Clause
// <adcgs-player src="scene.adcgs" autoplay loop controls>: a clip in the manner of <video>. Camera, clock and keys are those
// of the page and of `adcgs-dec --play`: the view of the decoder's module.
import { AdcgsError, open } from './adcgs.js';
import { Input } from './input.js';
import { CONTENT } from './player_content.js';
import { isBusy, isFast, paint, release } from './paint.js';
import { findPivot, styleLimits } from './region.js';

const Base = globalThis.HTMLElement ?? class {}; // a server may import this file, too

export class AdcgsPlayer extends Base {
    static observedAttributes = ['src', 'poster', 'controls', 'loop', 'camera', 'time', 'aria-label'];

    #clip = null;
    #error = null;
    #abort = null;          // of the clip being loaded
    #opened = null;         // promise: the view shows the clip
    #call = null;           // the functions of the module, once the view shows the clip
    #plays = false;         // the wish to play, before that
    #shown = {};            // the last image and the last state of the clock
    #asked = false;         // a step is due
    #input;
    #sizes = null;          // observes the element's size

    constructor() {
        super();
        this.attachShadow({ mode: 'open' }).innerHTML = CONTENT;
        this.#input = new Input(this, () => this.#wake());
        this.#listen(this.#part('canvas'));
        this.#part('play').addEventListener('click', () => this.#input.press(' '));
        this.#part('time').addEventListener('input', event => {
            const { timeStart, frameRate } = this.#clip.info;
            this.currentTime = timeStart + event.target.value / frameRate;
        });
        this.#part('controls').inert = true;
    }

    connectedCallback() {
        this.#sizes = new ResizeObserver(() => this.#wake());
        this.#sizes.observe(this);
        this.load();
    }

    disconnectedCallback() {
        this.#sizes.disconnect();
        this.#unload();
        this.#newCanvas();
    }

    attributeChangedCallback(name, old, value) {
        if (name === 'src' && this.isConnected)
            this.load();
        else if (name === 'poster')
            this.#showPoster();
        else if (name === 'controls')
            this.#part('controls').hidden = value === null;
        else if (name === 'loop' && this.#call)
            this.#start(this.currentTime, this.loop, !this.paused);
        else if (name === 'camera' && this.#call && value !== null)
            this.#try(() => this.setCamera(value));
        else if (name === 'time' && this.#call && value !== null)
            this.currentTime = Number(value);
        else if (name === 'aria-label')
            this.#part('canvas').setAttribute('aria-label', value ?? '');
    }

    // ---- The interface of scripts. ----

    get clip() { return this.#clip; }
    get error() { return this.#error; }
    get paused() { return !(this.#call ? this.#call.view_playing() : this.#plays); }
    get ended() {
        return this.#call !== null && this.paused && !this.loop && this.#call.view_frame() === this.#call.view_frames() - 1;
    }
    get duration() { return this.#clip ? this.#clip.info.duration : NaN; }
    get cameras() { return this.#clip ? this.#clip.info.cameras.map(camera => camera.name) : []; }
    get currentTime() { return this.#call ? this.#call.view_time() : Number(this.getAttribute('time') ?? 0); }
    set currentTime(seconds) {
        if (!Number.isFinite(Number(seconds)))
            throw new TypeError(`currentTime: ${seconds}, expected seconds`);
        if (this.#call)
            this.#start(Number(seconds), this.loop, !this.paused);
        else
            this.setAttribute('time', Number(seconds));
    }

    async play() {
        if (!this.#opened)
            throw new AdcgsError('USAGE', 'adcgs-player: no src');
        this.#plays = true;
        await this.#opened;
        if (this.#plays)
            this.#start(this.currentTime, this.loop, true);
    }

    pause() {
        this.#plays = false;
        if (this.#call)
            this.#start(this.currentTime, this.loop, false);
    }

    /** A stored camera by its name or index, 'home', or an object as for clip.render(). */
    setCamera(camera) {
        if (!this.#call)
            throw new AdcgsError('USAGE', 'adcgs-player: nothing to show yet');
        const isIndex = typeof camera === 'string' && /^\d+$/.test(camera) && !this.cameras.includes(camera);
        const bytes = this.#clip.view(isIndex ? Number(camera) : camera);
        this.#call.view_tick(performance.now() / 1000);
        this.#clip.use([bytes], at => this.#call.view_place(at));
        this.#wake();
    }

    load() {
        this.#unload();
        const src = this.getAttribute('src');
        if (!src)
            return;
        this.#abort = new AbortController();
        this.#plays = this.autoplay && !matchMedia('(prefers-reduced-motion: reduce)').matches;
        this.#opened = this.#load(new URL(src, this.baseURI), this.#abort.signal);
        this.#opened.catch(() => null); // #load() reports it
    }

    // ---- Loading. ----

    async #load(url, signal) {
        try {
            const clip = await open(url, { signal, wasm: this.getAttribute('wasm') ?? undefined });
            this.#clip = clip;
            this.#tell('loadedmetadata');
            clip.addEventListener('progress', () => this.#grow());
            clip.ready.then(() => this.#grow(), e => this.#fail(e, signal));
            await clip.playable;
            if (signal.aborted)
                throw signal.reason;
            this.#openView(clip);
            this.#tell('canplay');
        } catch (e) {
            this.#fail(e, signal);
            throw e;
        }
    }

    #unload() {
        this.#abort?.abort();
        this.#clip?.close();
        this.#clip = this.#call = this.#input.call = this.#opened = this.#error = null;
        this.#shown = {};
        this.#plays = false;
        this.#part('message').hidden = this.#part('controls').inert = true;
        this.#showPoster();
    }

    #fail(error, signal) {
        if (signal.aborted || this.#error)
            return;
        this.#error = error;
        this.#part('message').textContent = error.message;
        this.#part('message').hidden = this.#call !== null;
        this.dispatchEvent(new ErrorEvent('error', { error, message: error.message }));
    }

    #try(act) {
        try {
            act();
        } catch (e) {
            this.#fail(e, this.#abort.signal);
        }
    }

    #openView(clip) {
        const call = clip.engine.call, { timeStart } = clip.info;
        clip.use([clip.home()], at => call.view_open(call.page_info(), at, call.page_cameras(), clip.complete ? 1 : 0));
        this.#call = this.#input.call = call;
        this.#part('controls').inert = false;
        this.#start(Number(this.getAttribute('time') ?? timeStart), this.loop, this.#plays);
        if (this.hasAttribute('camera'))
            this.#try(() => this.setCamera(this.getAttribute('camera')));
    }

    #grow() {
        this.#tell('progress');
        if (this.#call) {
            this.#call.view_span(this.#call.page_info(), this.#clip.complete ? 1 : 0);
            this.#wake();
        }
    }

    // ---- The clock and the image. ----

    #start(seconds, loop, playing) {
        this.#call.view_tick(performance.now() / 1000);
        this.#call.view_start(seconds, loop ? 1 : 0, playing ? 1 : 0);
        this.#wake();
    }

    #wake() {
        if (this.#asked || !this.#call)
            return;
        this.#asked = true;
        requestAnimationFrame(() => {
            this.#asked = false;
            if (this.#call)
                this.#try(() => this.#step());
        });
    }

    #step() {
        const call = this.#call, dense = window.devicePixelRatio || 1;
        const pixels = length => Math.max(1, Math.round(length * dense));
        call.view_tick(performance.now() / 1000);
        call.view_resize(pixels(this.clientWidth), pixels(this.clientHeight), dense);
        findPivot(this.#clip, call);
        styleLimits(call, [this.#part('canvas')]);
        if (isFast(this.#part('canvas')) === null) this.#newCanvas();
        const isWaiting = isBusy(this.#part('canvas'));
        if (!isWaiting)
            this.#draw();
        this.#showClock();
        if (isWaiting || call.view_moving() || call.view_playing())
            this.#wake();
    }

    /** Renders, unless the canvas shows this already. If there is no WebGL2, slow moving images are smaller. */
    #draw() {
        const call = this.#call, clip = this.#clip, canvas = this.#part('canvas'), fast = isFast(canvas);
        const at = call.view_camera(fast || !call.view_moving() ? 1 : call.view_divider()), time = call.view_time();
        const camera = clip.engine.copy(at, call.page_camera_size()), key = [clip.generation, time, camera.join()].join();
        if (key === this.#shown.key)
            return;
        const begun = performance.now();
        paint(clip, canvas, camera, time);
        if (!fast)
            call.view_took((performance.now() - begun) / 1000);
        this.#shown.key = key;
        this.#part('poster').hidden = true;
    }

    #showClock() {
        const call = this.#call, frame = call.view_frame(), isPaused = this.paused, bar = this.#part('time');
        if (frame !== this.#shown.frame) {
            const text = this.currentTime.toFixed(2);
            bar.max = call.view_frames() - 1;
            bar.value = frame;
            bar.setAttribute('aria-valuetext', `${text} seconds`);
            this.#part('clock').textContent = `${text} s`;
            this.#shown.frame = frame;
            this.#tell('timeupdate');
        }
        if (isPaused !== (this.#shown.isPaused ?? true)) {
            this.#part('play').setAttribute('aria-label', isPaused ? 'Play' : 'Pause');
            this.#tell(isPaused ? 'pause' : 'play');
            if (isPaused && this.ended) this.#tell('ended');
        }
        this.#part('play').textContent = isPaused ? '▶' : '❚❚';
        this.#shown.isPaused = isPaused;
    }

    #tell(name) {
        this.dispatchEvent(new Event(name));
    }

    #part(name) {
        return this.shadowRoot.querySelector(`[part=${name}]`);
    }

    #showPoster() {
        const poster = this.getAttribute('poster'), image = this.#part('poster');
        image.hidden = !poster || this.#shown.key !== undefined;
        if (poster)
            image.src = poster;
    }

    /** A context that is lost or given back does not return: another canvas has one. */
    #newCanvas() {
        const old = this.#part('canvas');
        release(old);
        old.replaceWith(old.cloneNode());
        this.#shown = {};
        this.#listen(this.#part('canvas'));
    }

    #listen(canvas) {
        this.#input.listen(canvas);
        canvas.addEventListener('webglcontextlost', () => this.#wake());
    }
}

// Attributes as properties.
const define = (name, get, set) =>
    Object.defineProperty(AdcgsPlayer.prototype, name, { get, set, enumerable: true, configurable: true });
for (const name of ['src', 'poster', 'camera'])
    define(name, function () { return this.getAttribute(name) ?? ''; }, function (value) { this.setAttribute(name, value); });
for (const name of ['autoplay', 'loop', 'controls'])
    define(name, function () { return this.hasAttribute(name); },
           function (value) { this.toggleAttribute(name, Boolean(value)); });

if (globalThis.customElements && !customElements.get('adcgs-player'))
    customElements.define('adcgs-player', AdcgsPlayer);
