// SPDX-License-Identifier: BSD-2-Clause
// The decoder's module for the page and its worker: one instance and its memory.
'use strict';

const OK = 0, ERR_FPENV = -8;                               // adcgs/status.h
const ARRIVED_SEGMENT = 3, ARRIVED_END = 4;                 // adcgs/types.h
const MEMORY_SHARED = 2;                                    // a flag of memories in WebAssembly
const CAMERA = { WIDTH: 0, HEIGHT: 4, FORWARD: [56, 88, 120] }; // bytes in adcgs_camera: the third column of cam_to_world

/** The module that this browser can run: relaxed, exact, or null. The library finds out whether relaxed fuses. */
function chooseModule(modules, but) {
    return ['relaxed', 'exact'].find(name => name !== but && modules[name] && WebAssembly.validate(modules[name])) || null;
}

/** The memory that a module requires: position of its flags in the bytes, and initial and maximum numbers of pages. */
function memoryOf(bytes) {
    const name = '\x03env\x06memory\x02';
    let at = String.fromCharCode(...bytes.subarray(0, 4096)).indexOf(name) + name.length;
    const flags = at++;
    const number = () => {
        for (let value = 0, unit = 1; ; unit *= 128) {
            const byte = bytes[at++];
            value += unit * (byte & 127);
            if (!(byte > 127)) // also where other bytes end
                return value;
        }
    };
    return { flags, initial: number(), maximum: number() };
}

/** Memory that workers share; null if the browser does not allow it. */
function sharedMemory(limits) {
    try {
        return new WebAssembly.Memory({ ...limits, shared: true });
    } catch (e) {
        return null;
    }
}

class Engine {
    /**
     * An instance of the module in these bytes; its memory may be shared. Modules require shared memory. Clearing one flag makes
     * them accept unshared memory.
     */
    static async create(bytes, shared = false) {
        const { flags, initial, maximum } = memoryOf(bytes);
        let memory = shared ? sharedMemory({ initial, maximum }) : null, text = bytes;
        if (!memory) {
            text = bytes.slice();
            text[flags] &= ~MEMORY_SHARED;
            memory = new WebAssembly.Memory({ initial, maximum });
        }
        const engine = await Engine.over(await WebAssembly.compile(text), memory);
        engine.call._initialize();
        return engine;
    }

    /** An instance over a memory. It has no system: all system calls of the C library fail. */
    static async over(module, memory) {
        const refuse = () => 52; // ENOSYS
        const system = { fd_close: refuse, fd_seek: refuse, fd_write: refuse, clock_time_get: refuse };
        const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: system, env: { memory } });
        return Object.assign(new Engine(), { module, memory, call: instance.exports });
    }

    get shared() {
        return !(this.memory.buffer instanceof ArrayBuffer);
    }

    /** A view of memory, valid until the next call that may allocate. */
    bytes(at, length) {
        return new Uint8Array(this.memory.buffer, at, length);
    }

    copy(at, length) {
        return this.bytes(at, length).slice();
    }

    floats(at, length) {
        return new Float32Array(this.memory.buffer, at, length).slice();
    }

    text(at) {
        if (!at)
            return '';
        const all = new Uint8Array(this.memory.buffer);
        return new TextDecoder().decode(all.subarray(at, all.indexOf(0, at)).slice());
    }

    /** Copies the arrays into memory, calls use with their addresses, frees the copies, and returns the result. */
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
