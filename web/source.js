// SPDX-License-Identifier: BSD-2-Clause
// Sources of bytes: the page itself, a file, or a server, in pieces that can be rendered as they arrive.
'use strict';

const PIECE = 32768;

function fromBase64(text) {
    const binary = atob(text.trim()), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; i++)
        bytes[i] = binary.charCodeAt(i);
    return bytes;
}

async function unpack(text) {
    const packed = new Blob([fromBase64(text)]);
    return new Uint8Array(await new Response(packed.stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
}

/** Takes apart files whose pieces alternate: piece i of n of a file begins at its size * i / n. */
function separate(bytes, n, sizes) {
    const files = sizes.map(size => new Uint8Array(size));
    let at = 0;
    for (let i = 0; i < n; i++)
        for (const file of files) {
            const begin = Math.floor(file.length * i / n), length = Math.floor(file.length * (i + 1) / n) - begin;
            file.set(bytes.subarray(at, at += length), begin);
        }
    return files;
}

/** The two modules in the page, from one packed text of both: assemble.sh makes it. */
async function unpackModules() {
    const text = document.getElementById('modules').textContent.trim(), end = text.indexOf('\n');
    const [n, ...sizes] = text.slice(0, end).split(' ').map(Number);
    const [relaxed, exact] = separate(await unpack(text.slice(end)), n, sizes);
    return { relaxed, exact };
}

/** Bytes on their way to the worker: a limited number at a time, and none once it has enough. */
class Flow {
    constructor(ahead) {
        this.ahead = ahead;
        this.sent = this.taken = 0;
        this.over = false;
        this.changed = this.cancel = () => null;
    }

    take(taken) {
        this.taken = taken;
        this.changed();
    }

    end() {
        this.over = true;
        this.changed();
        this.cancel();
    }

    /** Wait for room. */
    async room() {
        while (!this.over && this.sent - this.taken > this.ahead)
            await new Promise(done => { this.changed = done; });
    }
}

/** Calls take(bytes) for each piece, which it may keep, until the stream or the flow ends. */
async function readStream(stream, flow, take) {
    const reader = stream.getReader();
    flow.cancel = () => reader.cancel().catch(() => null); // ends a read that waits
    while (!flow.over) {
        const { done, value } = await reader.read();
        if (done)
            return;
        for (let at = 0; at < value.length && !flow.over; at += PIECE) {
            const piece = value.slice(at, at + PIECE);
            flow.sent += piece.length;
            take(piece);
            await flow.room();
        }
    }
    flow.cancel();
}

function embeddedScene() {
    const scene = document.getElementById('scene');
    if (!scene)
        return null;
    const bytes = fromBase64(scene.textContent);
    return { name: scene.dataset.name || 'scene', stream: new Blob([bytes]).stream(), total: bytes.length };
}

async function sceneAt(url) {
    const name = decodeURIComponent(new URL(url, location.href).pathname.split('/').pop()) || url;
    let response;
    try {
        response = await fetch(url);
    } catch (e) {
        const why = location.protocol === 'file:' ? 'a page opened from a file may read no other files; drop it here'
                                                  : 'not found, or its server does not let other pages read it (CORS)';
        throw new Error(`${url}: ${why}`);
    }
    if (!response.ok)
        throw new Error(`${url}: the server answers ${response.status} ${response.statusText}`);
    return { name, stream: response.body, total: Number(response.headers.get('content-length')) || 0 };
}
