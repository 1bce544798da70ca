// SPDX-License-Identifier: BSD-2-Clause
// Rendering with WebGPU during motion: images as those of gpu.js. It sorts by itself, for each view, so a turned view waits for
// no message of the worker.
'use strict';

const SORT_BLOCK = 4096;        // splats that a workgroup sorts
const SHIFT_STRIDE = 256;       // bytes between two shifts, whose place is an offset of a uniform
const FIRST_IMAGES = 3;         // which show how fast the adapter is
const FIRST_MS = 1000;          // for these, at most; a graphics processor takes some 50
const SOFTWARE = /swiftshader|llvmpipe|lavapipe|software|basic render/i;

/** Whether a program stands in for the graphics processor. Browsers say so, or the adapter has such a program's name. */
function isSoftware(adapter) {
    const { isFallbackAdapter = adapter.isFallbackAdapter, vendor, architecture, device, description } = adapter.info || {};
    return Boolean(isFallbackAdapter) || SOFTWARE.test([vendor, architecture, device, description].join(' '));
}

const VIEW = `
struct View {
    right: vec4f, down: vec4f, forward: vec4f,  // scene to camera: rotation and translation
    lens: vec4f,                                // fx, fy, cx, cy
    limits: vec4f,
    size: vec2f,                                // of the image
    nearest: f32, screen: f32,                  // near plane; variance added to footprints
    n: u32,                                     // splats
}
@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> splats: array<vec4f>; // four each, as the texels of gpu.js
@group(0) @binding(2) var<storage, read> before: array<vec2u>; // keys and indices, sorted by the previous digits
`;

// A radix sort from the least significant digit on, stable, with keys of 32 bits: the order is that of the exact depths. A
// workgroup sorts a block in rounds of one element for each thread. 256 threads and 9 KiB of memory are within every limit.
const SORT = `${VIEW}
const DIGITS = 256u;            // also the threads of a workgroup
const BLOCK = ${SORT_BLOCK}u;
const WORDS = DIGITS / 32u;     // a bit for each thread
@group(1) @binding(0) var<storage, read_write> after: array<vec2u>;
@group(1) @binding(1) var<storage, read_write> counts: array<u32>; // of each digit in each block; then sums over all blocks
@group(1) @binding(2) var<uniform> shift: u32;
var<workgroup> tally: array<atomic<u32>, DIGITS>;
var<workgroup> sums: array<u32, DIGITS>;
var<workgroup> first: array<u32, DIGITS>;
var<workgroup> masks: array<atomic<u32>, DIGITS * WORDS>;

fn blocks() -> u32 { return (view.n + BLOCK - 1u) / BLOCK; }
fn end(block: u32) -> u32 { return min(view.n, (block + 1u) * BLOCK); }
fn digit_of(pair: vec2u) -> u32 { return (pair.x >> shift) % DIGITS; }

// The sum of the values of this thread and those before it.
fn sum_up_to(me: u32, value: u32) -> u32 {
    workgroupBarrier();
    sums[me] = value;
    workgroupBarrier();
    for (var step = 1u; step < DIGITS; step *= 2u) {
        var more = 0u;
        if (me >= step) { more = sums[me - step]; }
        workgroupBarrier();
        sums[me] += more;
        workgroupBarrier();
    }
    return sums[me];
}

// The farthest first: the bits of a positive float grow as the float does. Splats behind the camera come last.
@compute @workgroup_size(DIGITS)
fn make_keys(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) me: u32) {
    for (var i = group.x * BLOCK + me; i < end(group.x); i += DIGITS) {
        let depth = dot(view.forward.xyz, splats[4u * i].xyz) + view.forward.w;
        after[i] = vec2u(select(0xffffffffu, ~bitcast<u32>(depth), depth > 0.0), i);
    }
}

@compute @workgroup_size(DIGITS)
fn count(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) me: u32) {
    atomicStore(&tally[me], 0u);
    workgroupBarrier();
    for (var i = group.x * BLOCK + me; i < end(group.x); i += DIGITS) {
        atomicAdd(&tally[digit_of(before[i])], 1u);
    }
    workgroupBarrier();
    counts[me * blocks() + group.x] = atomicLoad(&tally[me]);
}

// A workgroup for each digit: counts become the numbers of equal digits in earlier blocks.
@compute @workgroup_size(DIGITS)
fn add_up(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) me: u32) {
    var total = 0u;
    for (var start = 0u; start < blocks(); start += DIGITS) {
        let block = start + me; let at = group.x * blocks() + block;
        var value = 0u;
        if (block < blocks()) { value = counts[at]; }
        let sum = sum_up_to(me, value);
        if (block < blocks()) { counts[at] = total + sum - value; }
        total += sums[DIGITS - 1u];
    }
    if (me == 0u) { counts[DIGITS * blocks() + group.x] = total; }
}

// In a round, each thread marks its place in the mask of its digit. The marks before its own are its rank.
@compute @workgroup_size(DIGITS)
fn scatter(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) me: u32) {
    let total = counts[DIGITS * blocks() + me];
    first[me] = sum_up_to(me, total) - total + counts[me * blocks() + group.x];
    for (var start = 0u; start < BLOCK; start += DIGITS) {
        let i = group.x * BLOCK + start + me; let word = me / 32u; let bit = 1u << (me % 32u);
        for (var w = 0u; w < WORDS; w++) { atomicStore(&masks[w * DIGITS + me], 0u); }
        var pair = vec2u(0u);
        if (i < view.n) { pair = before[i]; }
        let digit = digit_of(pair);
        workgroupBarrier();
        if (i < view.n) { atomicOr(&masks[word * DIGITS + digit], bit); }
        workgroupBarrier();
        if (i < view.n) {
            var rank = countOneBits(atomicLoad(&masks[word * DIGITS + digit]) & (bit - 1u));
            for (var w = 0u; w < word; w++) { rank += countOneBits(atomicLoad(&masks[w * DIGITS + digit])); }
            after[first[digit] + rank] = pair;
        }
        workgroupBarrier();
        for (var w = 0u; w < WORDS; w++) { first[me] += countOneBits(atomicLoad(&masks[w * DIGITS + me])); }
    }
}`;

// The shaders of gpu.js.
const PAINT = `${VIEW}
struct Corner {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,
    @location(1) @interpolate(flat) conic: vec4f, // and the logarithm of opacity
    @location(2) @interpolate(flat) colour: vec3f,
}

@vertex
fn place(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Corner {
    var out: Corner;
    out.position = vec4f(2.0, 2.0, 0.5, 1.0);
    let texel = 4u * before[instance].y; let first = splats[texel]; let q = splats[texel + 1u]; let scale = splats[texel + 2u].xyz;
    let rotation = transpose(mat3x3f(view.right.xyz, view.down.xyz, view.forward.xyz));
    let p = rotation * first.xyz + vec3f(view.right.w, view.down.w, view.forward.w);
    if (!(p.z > view.nearest) || !(first.w >= 1.0 / 255.0)) { return out; }
    let turn = mat3x3f(1.0 - 2.0 * (q.z * q.z + q.w * q.w), 2.0 * (q.y * q.z + q.x * q.w), 2.0 * (q.y * q.w - q.x * q.z),
                       2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.y * q.y + q.w * q.w), 2.0 * (q.z * q.w + q.x * q.y),
                       2.0 * (q.y * q.w + q.x * q.z), 2.0 * (q.z * q.w - q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
    let t = p.xy / p.z; let l = clamp(t, view.limits.xz, view.limits.yw); let j = view.lens.xy / p.z;
    let jacobian = mat3x3f(j.x, 0.0, 0.0, 0.0, j.y, 0.0, -j.x * l.x, -j.y * l.y, 0.0);
    let f = jacobian * rotation * turn * mat3x3f(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, 0.0, scale.z);
    let covariance = f * transpose(f);
    let a = covariance[0][0] + view.screen; let b = covariance[0][1]; let c = covariance[1][1] + view.screen; let det = a * c - b * b;
    if (!(det > 0.0)) { return out; }
    let reach = sqrt(2.0 * max(log(255.0 * first.w), 0.0));
    let middle = 0.5 * (a + c); let off = sqrt(max(middle * middle - det, 0.0));
    let large = middle + off; let small = max(middle - off, 0.0);
    var along = select(vec2f(0.0, 1.0), vec2f(1.0, 0.0), a >= c);
    if (abs(b) > 1e-6 * large) { along = normalize(vec2f(b, large - a)); }
    let corner = 2.0 * vec2f(f32(vertex % 2u), f32(vertex / 2u)) - 1.0;
    out.at = reach * (corner.x * sqrt(large) * along + corner.y * sqrt(small) * vec2f(-along.y, along.x));
    out.conic = vec4f(vec3f(c, -b, a) / det, log(first.w));
    out.colour = splats[texel + 3u].xyz;
    let pixel = view.lens.xy * t + view.lens.zw + out.at;
    out.position = vec4f(2.0 * pixel.x / view.size.x - 1.0, 1.0 - 2.0 * pixel.y / view.size.y, 0.5, 1.0);
    return out;
}

@fragment
fn paint(in: Corner) -> @location(0) vec4f {
    let at = in.at; let conic = in.conic;
    let alpha = exp(conic.w - 0.5 * (conic.x * at.x * at.x + 2.0 * conic.y * at.x * at.y + conic.z * at.y * at.y));
    if (alpha < 1.0 / 255.0) { discard; }
    return vec4f(in.colour * alpha, alpha);
}`;

class WebGpu {
    /** Rejects if the browser gives no adapter, or one in software unless any will do, however slow it is. */
    static async open(canvas, any) {
        const adapter = navigator.gpu ? await navigator.gpu.requestAdapter() : null;
        if (!adapter || (!any && isSoftware(adapter)))
            throw new Error('no WebGPU');
        const { maxStorageBufferBindingSize, maxBufferSize } = adapter.limits;
        const device = await adapter.requestDevice({ requiredLimits: { maxStorageBufferBindingSize, maxBufferSize } });
        const most = Math.min(maxStorageBufferBindingSize, maxBufferSize) >>> 6;
        const gpu = Object.assign(new WebGpu(), { kind: 'webgpu', sorts: true, canvas, device, most, n: 0, room: 0, sorted: 0,
                                                  lost: false, took: 0, working: false, any, images: 0, spent: 0, since: 0 });
        gpu.lose = () => { gpu.lost = true; };
        device.lost.then(gpu.lose);
        device.addEventListener('uncapturederror', gpu.lose); // memory, above all
        gpu.context = canvas.getContext('webgpu');
        gpu.format = navigator.gpu.getPreferredCanvasFormat();
        gpu.context.configure({ device, format: gpu.format, alphaMode: 'opaque' });
        await gpu.makePipelines();
        return gpu;
    }

    async makePipelines() {
        const { device } = this, both = GPUShaderStage.VERTEX | GPUShaderStage.COMPUTE, only = GPUShaderStage.COMPUTE;
        const layoutOf = (visibility, ...buffers) => device.createBindGroupLayout(
            { entries: buffers.map((buffer, binding) => ({ binding, visibility, buffer })) });
        const read = { type: 'read-only-storage' }, write = { type: 'storage' };
        this.scene = layoutOf(both, { type: 'uniform' }, read, read);
        this.step = layoutOf(only, write, write, { type: 'uniform', hasDynamicOffset: true });
        const layout = device.createPipelineLayout({ bindGroupLayouts: [this.scene, this.step] });
        const module = device.createShaderModule({ code: SORT }), painter = device.createShaderModule({ code: PAINT });
        const kernels = ['make_keys', 'count', 'add_up', 'scatter'];
        const blend = { srcFactor: 'one', dstFactor: 'one-minus-src-alpha' };
        [this.painter, ...this.kernels] = await Promise.all([
            device.createRenderPipelineAsync({
                layout: device.createPipelineLayout({ bindGroupLayouts: [this.scene] }), primitive: { topology: 'triangle-strip' },
                vertex: { module: painter, entryPoint: 'place' },
                fragment: { module: painter, entryPoint: 'paint', targets: [{ format: this.format, blend: { color: blend, alpha: blend } }] },
            }),
            ...kernels.map(entryPoint => device.createComputePipelineAsync({ layout, compute: { module, entryPoint } })),
        ]);
        this.numbers = this.buffer(112, GPUBufferUsage.UNIFORM);
        this.shifts = this.buffer(4 * SHIFT_STRIDE, GPUBufferUsage.UNIFORM);
        for (let digit = 0; digit < 4; digit++)
            device.queue.writeBuffer(this.shifts, digit * SHIFT_STRIDE, new Uint32Array([8 * digit]));
    }

    buffer(size, usage) {
        return this.device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC });
    }

    /** Buffers for this number of splats: two for pairs of key and index, since each digit moves them from one to the other. */
    reserve(n) {
        const { device, numbers, shifts } = this, group = (layout, ...resources) => device.createBindGroup(
            { layout, entries: resources.map((resource, binding) => ({ binding, resource })) });
        [this.texels, this.counts, ...this.pairs || []].forEach(old => old && old.destroy());
        this.texels = this.buffer(64 * n, GPUBufferUsage.STORAGE);
        this.counts = this.buffer(4 * 256 * (Math.ceil(n / SORT_BLOCK) + 1), GPUBufferUsage.STORAGE);
        this.pairs = [0, 1].map(() => this.buffer(8 * n, GPUBufferUsage.STORAGE));
        this.from = this.pairs.map(pairs => group(this.scene, { buffer: numbers }, { buffer: this.texels }, { buffer: pairs }));
        this.to = this.pairs.map(pairs => group(this.step, { buffer: pairs }, { buffer: this.counts }, { buffer: shifts, size: 4 }));
        this.room = n;
    }

    /** Uploads the splats at one time, 16 numbers each. */
    take(texels, n) {
        this.n = n <= this.most ? n : 0;
        this.sorted = 0;
        if (n > this.most)
            this.lose();
        else if (n > this.room)
            this.reserve(Math.min(n + (n >> 3), this.most));
        if (this.n)
            this.device.queue.writeBuffer(this.texels, 0, texels);
    }

    /** By the depth in the view: the last row of its rotation and translation. */
    sort(encoder) {
        const pass = encoder.beginComputePass(), blocks = Math.ceil(this.n / SORT_BLOCK);
        const run = (kernel, groups, from, digit) => {
            pass.setPipeline(this.kernels[kernel]);
            pass.setBindGroup(0, this.from[from]);
            pass.setBindGroup(1, this.to[1 - from], [digit * SHIFT_STRIDE]);
            pass.dispatchWorkgroups(groups);
        };
        run(0, blocks, 1, 0);
        for (let digit = 0; digit < 4; digit++)
            [blocks, 256, blocks].forEach((groups, i) => run(1 + i, groups, digit % 2, digit));
        pass.end();
        this.sorted = this.n;
    }

    /** Renders an image of the canvas. view: the 21 numbers of view_uniforms(). */
    draw(view, width, height, background, filter) {
        const { canvas, device } = this, row = i => [...view.subarray(3 * i, 3 * i + 3), view[9 + i]];
        if (canvas.width !== width || canvas.height !== height)
            Object.assign(canvas, { width, height });
        const numbers = new Float32Array([...row(0), ...row(1), ...row(2), ...view.subarray(12, 16), ...view.subarray(17, 21),
                                          width, height, view[16], filter]);
        device.queue.writeBuffer(this.numbers, 0, numbers);
        device.queue.writeBuffer(this.numbers, numbers.byteLength, new Uint32Array([this.n]));
        const encoder = device.createCommandEncoder(), [r, g, b] = background, axis = row(2).join();
        if (this.n && (this.sorted !== this.n || this.axis !== axis))
            this.sort(encoder);
        this.axis = axis;
        const pass = encoder.beginRenderPass({ colorAttachments: [{ view: this.context.getCurrentTexture().createView(),
                                                                    clearValue: { r, g, b, a: 1 }, loadOp: 'clear', storeOp: 'store' }] });
        if (this.n) {
            pass.setPipeline(this.painter);
            pass.setBindGroup(0, this.from[0]);
            pass.draw(4, this.n);
        }
        pass.end();
        device.queue.submit([encoder.finish()]);
        this.working = true;
        this.since = performance.now();
        device.queue.onSubmittedWorkDone().then(() => {
            this.working = false;
            this.took = performance.now() - this.since;
            if (this.images++ < FIRST_IMAGES)
                this.spent += this.took;
        }, this.lose);
    }

    /** Whether the first images took too long, or the one at work does. */
    get slow() {
        const now = this.working && this.images < FIRST_IMAGES ? performance.now() - this.since : 0;
        return !this.any && this.spent + now > FIRST_MS;
    }

    /** Whether the last image is still being rendered. A caller that waits for it never floods a slow GPU. Sets took, in ms. */
    busy() {
        return this.working;
    }

    /** The last image, rows from the top. Only the task that rendered it can read it. */
    pixels() {
        const { width, height } = this.canvas, copy = Object.assign(document.createElement('canvas'), { width, height });
        const context = copy.getContext('2d');
        context.drawImage(this.canvas, 0, 0);
        return context.getImageData(0, 0, width, height).data;
    }
}
