// SPDX-License-Identifier: BSD-2-Clause
// The decoder's module, as the page and its worker see it: one instance and its memory.
'use strict';

const OK = 0, ERR_FPENV = -8;                               // adcgs/status.h
const ARRIVED_SEGMENT = 3;                                  // adcgs/types.h
const CAMERA = { WIDTH: 0, HEIGHT: 4, FORWARD: [56, 88, 120] }; // bytes in adcgs_camera: the third column of cam_to_world

/** Which of the two modules runs here: relaxed, exact, or null. Whether relaxed fuses is for the library to find out. */
function chooseModule(modules, but) {
    return ['relaxed', 'exact'].find(name => name !== but && modules[name] && WebAssembly.validate(modules[name])) || null;
}

class Engine {
    /** An instance of the module in these bytes. It has no system: what the C library would ask of one fails. */
    static async create(bytes) {
        const refuse = () => 52; // ENOSYS
        const system = { fd_close: refuse, fd_seek: refuse, fd_write: refuse, clock_time_get: refuse };
        const { instance } = await WebAssembly.instantiate(bytes, { wasi_snapshot_preview1: system });
        const engine = new Engine();
        engine.call = instance.exports;
        engine.call._initialize();
        return engine;
    }

    /** A view of memory, until the next call that may allocate. */
    bytes(at, length) {
        return new Uint8Array(this.call.memory.buffer, at, length);
    }

    copy(at, length) {
        return this.bytes(at, length).slice();
    }

    floats(at, length) {
        return new Float32Array(this.call.memory.buffer, at, length).slice();
    }

    text(at) {
        if (!at)
            return '';
        const all = new Uint8Array(this.call.memory.buffer);
        return new TextDecoder().decode(all.subarray(at, all.indexOf(0, at)).slice());
    }

    /** Calls back with addresses of these bytes in memory, and gives the result. */
    with(arrays, use) {
        const at = arrays.map(a => this.call.page_alloc(Math.max(a.length, 1)));
        if (at.includes(0)) {
            at.forEach(a => this.call.page_free(a));
            throw new Error('out of memory');
        }
        arrays.forEach((a, i) => this.bytes(at[i], a.length).set(a));
        try {
            return use(...at);
        } finally {
            at.forEach(a => this.call.page_free(a));
        }
    }
}
