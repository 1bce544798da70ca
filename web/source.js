// SPDX-License-Identifier: BSD-2-Clause
// Where bytes come from: the page itself, a file, or a server, in pieces that can be drawn as they come.
'use strict';

const PIECE = 32768;

function fromBase64(text) {
    const binary = atob(text.trim()), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; i++)
        bytes[i] = binary.charCodeAt(i);
    return bytes;
}

async function unpack(id) {
    const packed = new Blob([fromBase64(document.getElementById(id).textContent)]);
    return new Uint8Array(await new Response(packed.stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer());
}

/** Calls take(bytes) for each piece, which it may keep. */
async function readStream(stream, take) {
    for (const reader = stream.getReader(); ;) {
        const { done, value } = await reader.read();
        if (done)
            return;
        for (let at = 0; at < value.length; at += PIECE)
            take(value.slice(at, at + PIECE));
    }
}

function embeddedScene() {
    const scene = document.getElementById('scene');
    return scene && { name: scene.dataset.name || 'scene', stream: new Blob([fromBase64(scene.textContent)]).stream() };
}

async function sceneAt(url) {
    const name = decodeURIComponent(new URL(url, location.href).pathname.split('/').pop()) || url;
    let response;
    try {
        response = await fetch(url);
    } catch (e) {
        const why = location.protocol === 'file:' ? 'a page that was opened from a file may read no others; drop it here'
                                                  : 'not there, or its server does not let other pages read it (CORS)';
        throw new Error(`${url}: ${why}`);
    }
    if (!response.ok)
        throw new Error(`${url}: the server says ${response.status} ${response.statusText}`);
    return { name, stream: response.body, total: Number(response.headers.get('content-length')) || 0 };
}
