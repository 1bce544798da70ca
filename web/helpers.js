// SPDX-License-Identifier: BSD-2-Clause
// Workers that help to draw: instances of the same module over the same memory. A page may share memory with workers where its
// server isolates it: Cross-Origin-Opener-Policy: same-origin, Cross-Origin-Embedder-Policy: require-corp. Elsewhere, and where
// none of them starts, the one thread does all.
'use strict';

const THREADS_MOST = 8;
const STACK = 1 << 20; // bytes of a helper's, as build.sh gives the first thread's

/** As many as there are processors, or as somebody wants. */
function threadsHere(wanted) {
    return self.crossOriginIsolated ? Math.min(wanted || navigator.hardwareConcurrency || 1, THREADS_MOST) : 1;
}

let helpers = []; // of the engine that there is

function dismissHelpers() {
    helpers.forEach(worker => worker.terminate());
    helpers = [];
}

/** This worker's own text in another one, which waits for tasks from its first message on. */
function startHelper(engine) {
    const room = engine.call.page_alloc(STACK);
    if (!room)
        throw new Error('out of memory');
    const worker = new Worker(self.location.href);
    worker.onerror = event => event.preventDefault();
    worker.postMessage({ kind: 'help', module: engine.module, memory: engine.memory, room });
    helpers.push(worker);
}

/** As many threads draw, counting this one, if all helpers come; else those that do. */
function startHelpers(engine, threads) {
    dismissHelpers();
    if (!engine.shared || engine.call.page_threads(threads) !== OK)
        return;
    try {
        for (let i = 1; i < threads; i++)
            startHelper(engine);
    } catch (e) {
        return; // it goes without
    }
}

/** A helper's life, which has no end. */
async function help({ module, memory, room }) {
    const { call } = await Engine.over(module, memory);
    call.__stack_pointer.value = room + STACK;
    call.page_help();
}
