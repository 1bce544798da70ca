// SPDX-License-Identifier: BSD-2-Clause
// A clip: a stream on its way or complete, its splats and images at any time.
import { AdcgsError } from './error.js';
import { ARRIVED_END, ARRIVED_SEGMENT, OK } from './engine.js';
import { lookAt, readCamera, readFilmed, writeCamera } from './camera.js';
import { paint } from './paint.js';

const TEXELS = 16; // numbers of a splat: centre and opacity, rotation, scale, colour, each with four (web/wasm/page_splats.c)

/** A promise that its owner settles. If nobody waits for it, its failure is no event of the page. */
function deferred() {
    let settle;
    const promise = new Promise((resolve, reject) => { settle = { resolve, reject }; });
    promise.catch(() => null);
    return { promise, ...settle };
}

function infoOf(facts, cameras) {
    const end = facts.time_end === null ? Infinity : facts.time_end;
    return {
        timeStart: facts.time_start, timeEnd: end, duration: end - facts.time_start, frameRate: facts.frame_rate,
        splats: facts.gaussians, anchors: facts.anchors, staticAnchors: facts.static_anchors, weights: facts.weights,
        segments: facts.segments, layers: facts.layers, tiers: facts.tiers, cameras,
        level: facts.level, version: facts.version, library: facts.library, bytes: facts.bytes,
        truncated: facts.truncated !== 0, background: facts.background, origin: facts.origin, scale: facts.scale,
        color: facts.colour, axes: facts.axes, metadata: facts.metadata,
    };
}

export class Clip extends EventTarget {
    #headed = deferred();
    #playable = deferred();
    #ready = deferred();
    #info = null;
    #isDrawable = false;
    #ended = false;
    #failed = false; // the decoder takes no more bytes
    #received = 0;

    /** For open(): an engine whose decoder waits for bytes. */
    constructor(engine) {
        super();
        this.engine = engine;
        this.generation = 0; // counts changes of the contents
        this.stopReading = () => null;
    }

    get headed() { return this.#headed.promise; }
    get playable() { return this.#playable.promise; }
    get ready() { return this.#ready.promise; }
    get closed() { return this.engine === null; }
    /** Whether some part can be shown. */
    get isPlayable() { return this.#isDrawable; }
    /** Whether no more bytes will come. */
    get complete() { return this.#ended; }

    // ---- Bytes. ----

    /** Takes bytes of the stream. Returns whether more are useful: the level of a stream bounds its size. */
    take(bytes) {
        if (!ArrayBuffer.isView(bytes))
            throw new AdcgsError('USAGE', 'open: the stream gives no bytes');
        const arrived = this.use([bytes], at => this.engine.call.page_push(at, bytes.length));
        this.#received += bytes.length;
        this.#failed = arrived < 0;
        if (arrived < 0)
            throw AdcgsError.from(this.engine, arrived);
        if (arrived > 0)
            this.#grow(arrived >= ARRIVED_SEGMENT);
        return arrived !== ARRIVED_END && this.#received < this.engine.call.page_useful();
    }

    /** No more bytes will come, for this reason if there is one. The available part remains. */
    finish(failure) {
        let reason = failure;
        if (this.closed) {
            reason ??= new AdcgsError('USAGE', 'the clip is closed');
        } else if (!this.#failed) {
            const status = this.engine.call.page_end();
            reason ??= status === OK ? null : AdcgsError.from(this.engine, status);
        }
        this.#ended = true;
        const facts = this.closed ? null : this.#facts();
        if (facts)
            this.#grow(facts.segments > 0);
        const missing = reason ?? new AdcgsError('TRUNCATED', 'the stream ends before anything can be shown');
        this.#headed.reject(missing);
        this.#playable.reject(missing);
        if (reason)
            this.#ready.reject(reason);
        else
            this.#ready.resolve();
    }

    #grow(isDrawable) {
        this.#isDrawable ||= isDrawable;
        this.#info = null;
        this.generation++;
        this.#headed.resolve();
        if (this.#isDrawable)
            this.#playable.resolve();
        this.dispatchEvent(new Event('progress'));
    }

    /** Frees the decoder. */
    close() {
        if (this.closed)
            return;
        this.engine = null;
        this.stopReading();
    }

    // ---- Contents. ----

    /** Calls use with the addresses of copies of the arrays in the engine's memory. */
    use(arrays, use) {
        if (this.closed)
            throw new AdcgsError('USAGE', 'the clip is closed');
        try {
            return this.engine.with(arrays, use);
        } catch (e) {
            throw e instanceof AdcgsError ? e : new AdcgsError(e.message === 'out of memory' ? 'MEMORY' : 'INTERNAL', e.message);
        }
    }

    #facts() {
        return this.use([], () => JSON.parse(this.engine.text(this.engine.call.page_facts()) || 'null'));
    }

    get info() {
        if (!this.#info) {
            const facts = this.#facts(), size = this.engine.call.page_filmed_size(), at = this.engine.call.page_cameras();
            const cameras = Array.from({ length: at ? facts.cameras : 0 },
                                       (_, i) => readFilmed(this.engine.copy(at + i * size, size)));
            this.#info = infoOf(facts, cameras);
            this.#info.available = facts.time_available ?? (this.#isDrawable && this.#ended ? this.#info.timeEnd : -Infinity);
        }
        return this.#info;
    }

    get available() { return this.info.available; }

    /** The first view, as bytes. */
    home() {
        const at = this.use([], () => this.#isDrawable ? this.engine.call.page_home() : 0);
        if (!at)
            throw new AdcgsError('USAGE', 'nothing to show yet: wait for clip.playable');
        return this.engine.copy(at, this.engine.call.page_camera_size());
    }

    #stored(wanted) {
        const { cameras } = this.info;
        const index = typeof wanted === 'number' ? wanted : cameras.findIndex(({ name }) => name === wanted);
        if (!cameras[index])
            throw new AdcgsError('USAGE', `no camera ${JSON.stringify(wanted)}: the clip stores ${cameras.length}`);
        return cameras[index];
    }

    /** The bytes of a camera, for an image of a size; by default its own. fit: as CSS's object-fit. */
    view(camera, width, height, fit) {
        const home = readCamera(this.home());
        let wanted = camera ?? 'home';
        if (wanted === 'home')
            wanted = home;
        else if (typeof wanted !== 'object')
            wanted = this.#stored(wanted);
        else if (wanted.position)
            wanted = lookAt(wanted, home, this.info.origin, width ?? wanted.width ?? home.width,
                            height ?? wanted.height ?? home.height);
        const bytes = writeCamera(wanted, this.engine.call.page_camera_size());
        return width === undefined && height === undefined ? bytes : this.use([bytes], at => {
            this.engine.call.page_fit(at, width ?? wanted.width, height ?? wanted.height, fit === 'cover' ? 1 : 0);
            return this.engine.copy(at, bytes.length);
        });
    }

    /** The splats at a time as the decoder's texels, which are valid until the next call. */
    texels(time) {
        const count = this.use([], () => this.engine.call.page_pack(time));
        if (count < 0)
            throw AdcgsError.from(this.engine, count);
        return { count, texels: new Float32Array(this.engine.memory.buffer, this.engine.call.page_texels(), TEXELS * count) };
    }

    /** The order of these splats from far to near along a direction, valid until the next call. */
    order(direction, count) {
        const at = this.use([], () => this.engine.call.page_sort(...direction));
        return new Uint32Array(this.engine.memory.buffer, at, count);
    }

    splats(time) {
        const { origin, scale } = this.info, { count, texels } = this.texels(time);
        const make = n => new Float32Array(n * count);
        const out = { count, positions: make(3), scales: make(3), rotations: make(4), colors: make(3), opacities: make(1) };
        for (let i = 0; i < count; i++) {
            const at = TEXELS * i;
            out.opacities[i] = texels[at + 3];
            for (let a = 0; a < 3; a++) {
                out.positions[3 * i + a] = origin[a] + scale * texels[at + a];
                out.scales[3 * i + a] = scale * texels[at + 8 + a];
                out.colors[3 * i + a] = texels[at + 12 + a];
            }
            out.rotations.set(texels.subarray(at + 4, at + 8), 4 * i);
        }
        return out;
    }

    // ---- Images. ----

    frame(camera, time, { width, height, fit } = {}) {
        return this.exact(this.view(camera, width, height, fit), time);
    }

    /** The exact image for a camera's bytes, with its MD5. */
    exact(bytes, time) {
        const call = this.use([], () => this.engine.call), status = this.use([bytes], at => call.page_draw(at, time, 0, 1));
        if (status !== OK)
            throw AdcgsError.from(this.engine, status);
        const { width, height } = readCamera(bytes);
        const data = new Uint8ClampedArray(this.engine.copy(call.page_pixels(), 4 * width * height).buffer);
        return { width, height, data, md5: this.engine.text(call.page_digest()) };
    }

    render(canvas, camera, time) {
        paint(this, canvas, this.view(camera, canvas.width, canvas.height), time);
    }
}
