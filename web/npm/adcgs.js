// SPDX-License-Identifier: BSD-2-Clause
// Opens clips: const clip = await open(url).
import { AdcgsError } from './error.js';
import { Clip } from './clip.js';
import { Flow, readStream } from './source.js';
import { checked, get, isResponse, startEngine } from './module.js';

export { AdcgsError, Clip };

const SLICE_MS = 12; // of decoding, before other tasks of this thread have their turn

/** Makes readStream() decode for a limited time at once. */
class Slices extends Flow {
    constructor() {
        super(Infinity);
        this.begun = performance.now();
    }

    async room() {
        if (performance.now() - this.begun < SLICE_MS)
            return;
        await new Promise(done => setTimeout(done));
        this.begun = performance.now();
    }
}

async function streamOf(source, signal) {
    if (typeof source === 'string' || source instanceof URL)
        return streamOf(await get(source, signal), signal);
    if (isResponse(source))
        return checked(source).body || new Blob([]).stream();
    if (typeof source?.getReader === 'function')
        return source;
    if (typeof source?.stream === 'function') // a Blob
        return source.stream();
    if (ArrayBuffer.isView(source) || Object.prototype.toString.call(source) === '[object ArrayBuffer]')
        return new Blob([source]).stream();
    throw new AdcgsError('USAGE', `open: expected an address, Response, Blob, bytes or ReadableStream, not ${typeof source}`);
}

/** Gives the stream to the clip, up to its end, a failure, or an abort. */
async function receive(clip, stream, signal) {
    const flow = new Slices(), stop = () => flow.end();
    clip.stopReading = stop;
    signal?.addEventListener('abort', stop);
    let failure = null;
    try {
        await readStream(stream, flow, bytes => {
            if (!clip.take(bytes))
                flow.end();
        });
    } catch (e) {
        failure = e instanceof AdcgsError ? e : new AdcgsError('IO', `the stream ends early: ${e.message}`);
    }
    signal?.removeEventListener('abort', stop);
    flow.end();
    clip.finish(signal?.aborted ? signal.reason : failure);
}

/** Opens a clip: resolves when its header has arrived. clip.playable and clip.ready report the rest. */
export async function open(source, { signal, wasm } = {}) {
    signal?.throwIfAborted();
    const incoming = streamOf(source, signal), begun = startEngine(wasm);
    try {
        await Promise.all([incoming, begun]);
        signal?.throwIfAborted();
    } catch (e) {
        incoming.then(stream => stream.cancel()).catch(() => null);
        throw e;
    }
    const clip = new Clip(await begun);
    receive(clip, await incoming, signal);
    await clip.headed;
    return clip;
}
