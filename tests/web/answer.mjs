// SPDX-License-Identifier: BSD-2-Clause
// Runs the decoder for WASI (adcgs-answer-*.wasm) under node: node answer.mjs MODULE REQUESTS FILE
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { WASI } from 'node:wasi';

const [module, requests, file] = process.argv.slice(2);
const wasi = new WASI({
    version: 'preview1',
    args: ['adcgs-answer', resolve(requests), resolve(file)],
    preopens: { '/': '/' },
    returnOnExit: true,
});
const { instance } = await WebAssembly.instantiate(readFileSync(module), { wasi_snapshot_preview1: wasi.wasiImport });
process.exitCode = wasi.start(instance);
