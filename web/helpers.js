// SPDX-License-Identifier: BSD-2-Clause
// Workers that help to render: instances of the same module over the same memory. A page may share memory with workers if its
// server isolates it: Cross-Origin-Opener-Policy: same-origin, Cross-Origin-Embedder-Policy: require-corp. Otherwise, or if no
// helper starts, one thread does all the work.
'use strict';

const THREADS_MOST = 8;
const STACK = 1 << 20; // bytes of a helper's stack, the same as build.sh gives the first thread

/** Number of threads: as many as processors, or as wanted. */
function threadsHere(wanted) {
    return self.crossOriginIsolated ? Math.min(wanted || navigator.hardwareConcurrency || 1, THREADS_MOST) : 1;
}

let helpers = []; // of the current engine

function dismissHelpers() {
    helpers.forEach(worker => worker.terminate());
    helpers = [];
}

/** Starts this worker's own text in another worker, which waits for tasks after its first message. */
function startHelper(engine) {
    const room = engine.call.page_alloc(STACK);
    if (!room)
        throw new Error('out of memory');
    const worker = new Worker(self.location.href);
    worker.onerror = event => event.preventDefault();
    worker.postMessage({ kind: 'help', module: engine.module, memory: engine.memory, room });
    helpers.push(worker);
}

/** Starts helpers, so that this number of threads, including this one, renders; fewer if some helpers do not start. */
function startHelpers(engine, threads) {
    dismissHelpers();
    if (!engine.shared || engine.call.page_threads(threads) !== OK)
        return;
    try {
        for (let i = 1; i < threads; i++)
            startHelper(engine);
    } catch (e) {
        return; // continue with fewer threads
    }
}

/** Main loop of a helper; never returns. */
async function help({ module, memory, room }) {
    const { call } = await Engine.over(module, memory);
    call.__stack_pointer.value = room + STACK;
    call.page_help();
}
