// SPDX-License-Identifier: BSD-2-Clause
// Images during motion, by WebGPU, WebGL2 and the decoder: node moving.mjs chromium|firefox COMMAND FOLDER [full]; in the build
// folder. FOLDER has share.html. Without an adapter of WebGPU, its parts are skipped.
import * as kit from './page_kit.mjs';
import { check, full, go, kind, run, runParts, same } from './page_kit.mjs';

const urlOf = (name, query = '') => kit.urlOf(name, `?autoplay=0${query}`);
// Chromium gives an adapter in software, where a machine has no other.
const flags = ['--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader',
               '--use-angle=swiftshader'];
const WEBGL = "(document.createElement('canvas').getContext('webgl2') ? 'webgl2' : 'none')"; // the interface without WebGPU
let webgpu = false; // whether the page has WebGPU
const DECIBELS = 40; // of an image against the exact one

/** While the pointer is held, the GPU renders repeatedly, finally with splats sorted for this view. */
const ORBIT = `adcgs.adaptive = false;
    let images = 0, fast = null, line = '';
    adcgs.on('frame', ({ exact }) => {
        if (exact)
            return;
        images++;
        fast = adcgs.gpu.pixels();
        line = document.getElementById('line').textContent;
    });
    const orbit = async () => {
        pointer('pointerdown', 100, 80);
        for (let i = 0; i < 8; i++) {
            pointer('pointermove', 100 + 4 * i, 80 + i);
            await sleep(30);
        }
        images = 0;
        await until(() => {
            pointer('pointermove', 128, 87);
            const { gpu } = adcgs;
            images = gpu && gpu.n && gpu.sorted === gpu.n && document.getElementById('fast') === gpu.canvas ? images : 0;
            return images > 2;
        }, 'image of the GPU');
    };
    const release = async () => {
        const n = adcgs.pictures;
        pointer('pointerup', 128, 87);
        await until(() => adcgs.pictures > n && document.getElementById('exact').style.opacity === '1', 'exact image');
    };
    const decibels = fast => {
        const exact = document.getElementById('exact'), slow = exact.getContext('2d').getImageData(0, 0, exact.width, exact.height).data;
        let sum = slow.length === fast.length ? 0 : Infinity;
        for (let i = 0; i < slow.length; i++)
            sum += (slow[i] - fast[i]) ** 2;
        return 10 * Math.log10(255 * 255 / (sum / (0.75 * slow.length)));
    };
`;

/** Go to a page that wants this kind of GPU. Returns whether it is there. */
async function goWith(wanted) {
    await go(urlOf('share.html', `&gpu=${wanted}`));
    const notes = await run(`await settled(); await adcgs.gpuChosen;
        return adcgs.gpuKind === '${wanted}' ? null : adcgs.notes.join();`);
    if (notes !== null)
        console.log(`skipped: images by ${wanted} in ${kind}: ${notes}`);
    return notes === null;
}

/** Orbits, then compares the GPU's image with the exact one. Returns the decibels. */
async function compare(name) {
    const got = await run(`${ORBIT} await orbit();
        const seen = { line, kind: adcgs.gpuKind };
        await release();
        return { ...seen, psnr: decibels(fast), ...adcgs.fast };`);
    same(got.kind, name, 'the GPU in use');
    check(/not exact\s*$/.test(got.line), `line below the image by ${name}: "${got.line}"`);
    console.log(`${kind}: ${name} ${got.psnr.toFixed(1)} dB, ${got.n} splats, ${(got.tookMs || 0).toFixed(1)} ms`);
    return got.psnr;
}

/** Images by both, if this test is to take longer. The page with WebGPU is that of the next parts. */
async function images() {
    const psnr = full && await goWith('webgl2') ? await compare('webgl2') : DECIBELS;
    check(psnr >= DECIBELS, `the image by WebGL2 has ${psnr} dB against the exact one`);
    webgpu = await goWith('webgpu');
    const other = webgpu ? await compare('webgpu') : psnr;
    check(other >= psnr - 0.5, `the image by WebGPU has ${other} dB, that by WebGL2 ${psnr}`);
}

/** While the view turns, the worker gets no message, and each image has an order of its own. */
async function turns() {
    if (!webgpu)
        return;
    const got = await run(`${ORBIT} const sent = [], { postMessage } = Worker.prototype, { gpu } = adcgs, axes = new Set(), { sort } = gpu;
        Worker.prototype.postMessage = function (m, ...rest) { sent.push(m.kind); postMessage.call(this, m, ...rest); };
        gpu.sort = function (encoder) { axes.add(this.axis); sort.call(this, encoder); };
        pointer('pointerdown', 128, 87);
        for (let turn = 1; turn <= 3; turn++) {
            await until(() => { // a slow GPU may miss a single event
                pointer('pointermove', 128 + 20 * turn, 87);
                return axes.size >= turn;
            }, 'order of a turned view');
        }
        await release();
        Worker.prototype.postMessage = postMessage;
        delete gpu.sort;
        return sent.filter(kind => kind === 'sort' || kind === 'splats');`);
    same(got, [], 'messages to the worker about turned views');
}

/** Depths of random splats and views are exact in binary32, so that there is one order: the farthest first, else by index. */
const SORTED = `const read = async (device, from, size) => {
        const to = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
        const encoder = device.createCommandEncoder();
        encoder.copyBufferToBuffer(from, 0, to, 0, size);
        device.queue.submit([encoder.finish()]);
        await to.mapAsync(GPUMapMode.READ);
        return new Uint32Array(to.getMappedRange());
    };
    let seed = 1;
    const random = n => (seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0) % n;
    const firstWrong = async (gpu, n, axis, move) => {
        const texels = new Float32Array(16 * n);
        for (let i = 0; i < n; i++)
            texels.set([0, 1, 2].map(() => (random(65536) >> 4) / 16 - 128), 16 * i);
        const depths = Float32Array.from({ length: n }, (_, i) => Math.max(0, move + axis.reduce((sum, x, k) => sum + x * texels[16 * i + k], 0)));
        const expected = Uint32Array.from(depths.keys()).sort((a, b) => depths[b] - depths[a] || a - b);
        const view = new Float32Array(21);
        view.set(axis, 6);
        view[11] = move;
        gpu.take(texels.buffer, n);
        gpu.draw(view, 16, 16, [0, 0, 0], 0.3);
        const pairs = await read(gpu.device, gpu.pairs[0], 8 * n);
        return expected.findIndex((index, i) => pairs[2 * i + 1] !== index);
    };
`;

/** WebGPU sorts: a part of a block, some blocks, more blocks than a workgroup has threads. */
async function order() {
    if (!webgpu)
        return;
    const counts = [1, 4096, 10000, ...full ? [1100000] : []];
    const got = await run(`${SORTED} const { gpu } = adcgs, wrong = [];
        for (const n of ${JSON.stringify(counts)})
            wrong.push(await firstWrong(gpu, n, [0.5, -0.25, 0.75], 32));
        wrong.push(await firstWrong(gpu, 5000, [0, 0, -1], 100));
        return { wrong, lost: gpu.lost };`);
    same(got, { wrong: [...counts, 0].map(() => -1), lost: false }, `first wrong place in the order of ${counts} splats`);
}

/** A lost device: WebGL2 continues, and after that the decoder. */
async function lost() {
    if (!webgpu)
        return;
    const wake = `const wake = () => { pointer('pointerdown', 100, 80); pointer('pointermove', 104, 80); pointer('pointerup', 104, 80); };`;
    const next = await run(`${wake} adcgs.gpu.device.destroy();
        await until(() => !adcgs.gpu || adcgs.gpu.lost, 'loss');
        wake();
        await until(() => adcgs.gpuKind !== 'webgpu', 'other GPU after WebGPU');
        return [adcgs.gpuKind, ${WEBGL}];`);
    same(next[0], next[1], 'the GPU in use after WebGPU');
    if (next[0] !== 'webgl2')
        return;
    const psnr = await compare('webgl2');
    check(psnr >= DECIBELS, `the image by WebGL2 after WebGPU has ${psnr} dB`);
    const got = await run(`${wake} const canvases = document.querySelectorAll('#fast').length, n = adcgs.pictures;
        adcgs.gpu.gl.getExtension('WEBGL_lose_context').loseContext();
        await until(() => !adcgs.gpu || adcgs.gpu.lost, 'loss');
        wake();
        await until(() => adcgs.pictures > n && adcgs.drawn.exact, 'exact image');
        return { canvases, kind: adcgs.gpuKind, notes: adcgs.notes.join() };`);
    same([got.canvases, got.kind], [1, 'none'], 'canvases, and the GPU in use after both losses');
    check(/WebGPU was lost,WebGL2 was lost: .*rendered exactly/.test(got.notes), `notes after the losses: ${got.notes}`);
}

/** Where WebGPU does not finish its first images in time, WebGL2 renders, unless the address wants WebGPU. */
async function slow() {
    if (!webgpu || !await goWith('webgpu'))
        return;
    const got = await run(`const { gpu } = adcgs, start = performance.now();
        gpu.device.queue.onSubmittedWorkDone = () => new Promise(() => null);
        pointer('pointerdown', 100, 80);
        let n = 0;
        const move = () => pointer('pointermove', 100 + n++ % 20, 80);
        await until(() => { move(); return performance.now() - start > 1500 && gpu.working; }, 'image at work');
        const patient = adcgs.gpuKind;
        gpu.any = false;
        await until(() => { move(); return adcgs.gpuKind !== 'webgpu'; }, 'other GPU after WebGPU');
        pointer('pointerup', 100, 80);
        return { patient, kind: adcgs.gpuKind, notes: adcgs.notes.join() };`);
    same(got, { patient: 'webgpu', kind: 'webgl2', notes: 'WebGPU was slow' }, 'the GPU in use after slow images');
}

/** By default no GPU in software replaces WebGL2. Without both the decoder renders, and a note says so. */
async function choices() {
    await go(urlOf('share.html'));
    const usual = await run(`await settled();
        await adcgs.gpuChosen;
        const adapter = await navigator.gpu?.requestAdapter();
        const infos = [{ architecture: 'swiftshader' }, { description: 'llvmpipe (LLVM 15)' }, { description: 'Microsoft Basic Render Driver' },
                       { isFallbackAdapter: true }, { vendor: 'intel', architecture: 'gen-12lp', isFallbackAdapter: false }, null];
        return { slow: !adapter || adapter.info.isFallbackAdapter, kind: adcgs.gpuKind, webgl: ${WEBGL},
                 software: infos.map(info => isSoftware({ info })) };`);
    same(usual.software, [true, true, true, true, false, false], 'adapters in software');
    same(usual.kind, usual.slow ? usual.webgl : 'webgpu', 'the GPU in use by default');
    await go(urlOf('share.html', full ? '&draw=exact' : '&gpu=none'));
    const got = await run(`await settled(); const n = adcgs.pictures;
        pointer('pointerdown', 100, 80);
        for (let i = 0; i < 10; i++) {
            pointer('pointermove', 100 + 6 * i, 80);
            await sleep(40);
        }
        pointer('pointerup', 160, 80);
        await until(() => adcgs.pictures > n + 1 && adcgs.drawn.exact, 'images');
        return { kind: adcgs.gpuKind, ...report() };`);
    same(got.kind, 'none', 'the GPU in use');
    check(got.notes.some(note => /rendered exactly/.test(note)), 'it does not say that no GPU renders');
}

await runParts([images, turns, order, lost, slow, choices], 240, 180, { flags });
