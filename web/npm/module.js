// SPDX-License-Identifier: BSD-2-Clause
// The decoder's module: loaded once, an instance for each clip.
import { AdcgsError } from './error.js';
import { ERR_FPENV, Engine, OK, memoryOf } from './engine.js';

/** A module with f32x4.relaxed_madd: a browser that validates it can run the faster decoder. */
const RELAXED = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 19, 1, 17, 0,
                              65, 0, 253, 17, 65, 0, 253, 17, 65, 0, 253, 17, 253, 133, 2, 11);

// Bundlers look for these expressions, and copy the files.
const exactUrl = () => new URL('./adcgs.wasm', import.meta.url);
const relaxedUrl = () => new URL('./adcgs-relaxed.wasm', import.meta.url);

const loaded = new Map(); // address: promise of the compiled module, and the limits of its memory

/** The response for an address; a failure becomes an AdcgsError. */
export async function get(url, signal) {
    let response;
    try {
        response = await fetch(url, { signal });
    } catch (e) {
        if (signal?.aborted)
            throw signal.reason;
        throw new AdcgsError('IO', `${url}: not found, or its server does not let other pages read it (CORS)`);
    }
    return checked(response);
}

export function checked(response) {
    if (!response.ok)
        throw new AdcgsError('IO', `${response.url}: the server answers ${`${response.status} ${response.statusText}`.trim()}`);
    return response;
}

/** The class would not do: the response may be that of another frame. */
export const isResponse = source => typeof source?.arrayBuffer === 'function' && 'ok' in source;

async function compile(source) {
    const data = isResponse(source) ? await checked(source).arrayBuffer() : source;
    const bytes = ArrayBuffer.isView(data) ? new Uint8Array(data.buffer, data.byteOffset, data.byteLength) : new Uint8Array(data);
    try {
        return { engine: await Engine.create(bytes), limits: memoryOf(bytes) };
    } catch (e) {
        throw new AdcgsError('UNSUPPORTED', `the decoder's module does not start here: ${e.message}`);
    }
}

async function load(source) {
    const key = typeof source === 'string' || source instanceof URL ? String(source) : null;
    if (key === null)
        return (await compile(await source)).engine;
    if (loaded.has(key)) {
        const { module, limits: { initial, maximum } } = await loaded.get(key);
        const engine = await Engine.over(module, new WebAssembly.Memory({ initial, maximum }));
        engine.call._initialize();
        return engine;
    }
    const first = get(source).then(compile);
    loaded.set(key, first.then(({ engine, limits }) => ({ module: engine.module, limits }))); // not the memory of this instance
    loaded.get(key).catch(() => loaded.delete(key));
    return (await first).engine;
}

/** An instance whose decoder waits for bytes. wasm: another place of the module, or the module itself. */
export async function startEngine(wasm) {
    let engine, status;
    for (const source of wasm ? [wasm] : [...WebAssembly.validate(RELAXED) ? [relaxedUrl()] : [], exactUrl()]) {
        engine = await load(source);
        status = engine.call.page_open();
        if (status !== ERR_FPENV) // else relaxed operations do not fuse here
            break;
    }
    if (status !== OK)
        throw AdcgsError.from(engine, status);
    return engine;
}
