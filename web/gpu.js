// SPDX-License-Identifier: BSD-2-Clause
// Rendering with WebGL2 during motion: the formulas of the specification's clause on projection, in the GPU's arithmetic.
'use strict';

const VERTEX = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D splats;       // four texels each: centre and opacity, rotation, scale, colour
uniform vec2 size;              // of the image
uniform mat3 rotation;          // scene to camera
uniform vec3 translation;
uniform vec4 lens;              // fx, fy, cx, cy
uniform vec4 limits;
uniform float nearest, screen;  // near plane; variance added to footprints
uniform vec2 depth;             // the depth of a splat is depth.x + depth.y / z; the page, which has nothing else, leaves it 0
in vec2 corner;
in uint index;
out vec2 at;
flat out vec4 conic;            // and the logarithm of opacity
flat out vec3 colour;

vec4 texel(int i) {
    int place = int(index) * 4 + i, width = textureSize(splats, 0).x;
    return texelFetch(splats, ivec2(place % width, place / width), 0);
}

void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    vec4 first = texel(0), q = texel(1);
    vec3 p = rotation * first.xyz + translation, scale = texel(2).xyz;
    if (!(p.z > nearest) || !(first.w >= 1.0 / 255.0))
        return;
    mat3 turn = mat3(1.0 - 2.0 * (q.z * q.z + q.w * q.w), 2.0 * (q.y * q.z + q.x * q.w), 2.0 * (q.y * q.w - q.x * q.z),
                     2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.y * q.y + q.w * q.w), 2.0 * (q.z * q.w + q.x * q.y),
                     2.0 * (q.y * q.w + q.x * q.z), 2.0 * (q.z * q.w - q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
    vec2 t = p.xy / p.z, l = clamp(t, limits.xz, limits.yw), j = lens.xy / p.z;
    mat3 jacobian = mat3(j.x, 0.0, 0.0, 0.0, j.y, 0.0, -j.x * l.x, -j.y * l.y, 0.0);
    mat3 f = jacobian * rotation * turn * mat3(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, 0.0, scale.z);
    mat3 covariance = f * transpose(f);
    float a = covariance[0][0] + screen, b = covariance[0][1], c = covariance[1][1] + screen, det = a * c - b * b;
    if (!(det > 0.0))
        return;
    float reach = sqrt(2.0 * max(log(255.0 * first.w), 0.0));
    float middle = 0.5 * (a + c), off = sqrt(max(middle * middle - det, 0.0));
    float large = middle + off, small = max(middle - off, 0.0);
    vec2 along = abs(b) > 1e-6 * large ? normalize(vec2(b, large - a)) : a >= c ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    at = reach * (corner.x * sqrt(large) * along + corner.y * sqrt(small) * vec2(-along.y, along.x));
    conic = vec4(vec3(c, -b, a) / det, log(first.w));
    colour = texel(3).xyz;
    vec2 pixel = lens.xy * t + lens.zw + at;
    gl_Position = vec4(2.0 * pixel.x / size.x - 1.0, 1.0 - 2.0 * pixel.y / size.y, depth.x + depth.y / p.z, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float;
in vec2 at;
flat in vec4 conic;
flat in vec3 colour;
out vec4 result;
void main() {
    float alpha = exp(conic.w - 0.5 * (conic.x * at.x * at.x + 2.0 * conic.y * at.x * at.y + conic.z * at.y * at.y));
    if (alpha < 1.0 / 255.0)
        discard;
    result = vec4(colour * alpha, alpha);
}`;

class Gpu {
    /** Throws if WebGL2, or a part of it that is needed, is missing. */
    constructor(canvas) {
        const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, preserveDrawingBuffer: true });
        if (!gl)
            throw new Error('no WebGL2');
        this.kind = 'webgl2';
        this.sorts = false;     // it needs the order of the worker
        this.gl = gl;
        this.canvas = canvas;
        this.n = 0;
        this.lost = false;
        this.fence = null;      // of the last image
        this.took = 0;
        canvas.addEventListener('webglcontextlost', () => { this.lost = true; });
        this.program = this.link();
        this.uniform = {};
        for (const name of ['splats', 'size', 'rotation', 'translation', 'lens', 'limits', 'nearest', 'screen'])
            this.uniform[name] = gl.getUniformLocation(this.program, name);
        this.makeQuads();
        this.texture = gl.createTexture();
        this.width = Math.min(4096, gl.getParameter(gl.MAX_TEXTURE_SIZE));
    }

    link() {
        const gl = this.gl, program = gl.createProgram();
        for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
            const shader = gl.createShader(type);
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
                throw new Error('WebGL2: ' + gl.getShaderInfoLog(shader));
            gl.attachShader(program, shader);
        }
        gl.bindAttribLocation(program, 0, 'corner');
        gl.bindAttribLocation(program, 1, 'index');
        gl.linkProgram(program);
        if (!gl.getProgramParameter(program, gl.LINK_STATUS))
            throw new Error('WebGL2: ' + gl.getProgramInfoLog(program));
        return program;
    }

    makeQuads() {
        const gl = this.gl;
        this.array = gl.createVertexArray();
        gl.bindVertexArray(this.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
        gl.enableVertexAttribArray(0);
        gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
        this.indices = gl.createBuffer();
        gl.bindBuffer(gl.ARRAY_BUFFER, this.indices);
        gl.enableVertexAttribArray(1);
        gl.vertexAttribIPointer(1, 1, gl.UNSIGNED_INT, 0, 0);
        gl.vertexAttribDivisor(1, 1);
    }

    /** Uploads the splats at one time, 16 numbers each. */
    take(texels, n) {
        const gl = this.gl, width = this.width, height = Math.max(1, Math.ceil(4 * n / width));
        const padded = new Float32Array(4 * width * height);
        padded.set(new Float32Array(texels));
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, padded);
        this.n = n;
    }

    /** Uploads the order of rendering. */
    sort(indices) {
        const gl = this.gl;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.indices);
        gl.bufferData(gl.ARRAY_BUFFER, indices, gl.DYNAMIC_DRAW);
        this.sorted = indices.byteLength / 4;
    }

    /** Begins an image: for each eye of a headset, and for the canvas, paint() follows. */
    begin(framebuffer, width, height, background) {
        const gl = this.gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        gl.viewport(0, 0, width, height);
        gl.clearColor(background[0], background[1], background[2], 1);
        gl.clear(gl.COLOR_BUFFER_BIT);
    }

    /** view: the 21 numbers of view_uniforms(). box: x, y, width and height of its part of the image. */
    paint(view, { x, y, width, height }, filter) {
        const gl = this.gl, u = this.uniform;
        gl.viewport(x, y, width, height);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        gl.useProgram(this.program);
        gl.bindVertexArray(this.array);
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.uniform1i(u.splats, 0);
        gl.uniform2f(u.size, width, height);
        gl.uniformMatrix3fv(u.rotation, true, view.subarray(0, 9));
        gl.uniform3fv(u.translation, view.subarray(9, 12));
        gl.uniform4fv(u.lens, view.subarray(12, 16));
        gl.uniform1f(u.nearest, view[16]);
        gl.uniform4fv(u.limits, view.subarray(17, 21));
        gl.uniform1f(u.screen, filter);
        if (this.n && this.sorted === this.n)
            gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.n);
    }

    /** Renders an image of the canvas. */
    draw(view, width, height, background, filter) {
        const gl = this.gl;
        if (this.canvas.width !== width || this.canvas.height !== height) {
            this.canvas.width = width;
            this.canvas.height = height;
        }
        this.begin(null, width, height, background);
        this.paint(view, { x: 0, y: 0, width, height }, filter);
        this.fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        this.since = performance.now();
        gl.flush();
    }

    /** Whether the last image is still being rendered. A caller that waits for it never floods a slow GPU. Sets took, in ms. */
    busy() {
        const gl = this.gl;
        if (!this.fence)
            return false;
        if (gl.clientWaitSync(this.fence, 0, 0) === gl.TIMEOUT_EXPIRED)
            return true;
        gl.deleteSync(this.fence);
        this.fence = null;
        this.took = performance.now() - this.since;
        return false;
    }

    /** The last image, rows from the top. */
    pixels() {
        const gl = this.gl, width = this.canvas.width, height = this.canvas.height;
        const rows = new Uint8Array(4 * width * height), out = new Uint8ClampedArray(rows.length);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
        for (let y = 0; y < height; y++)
            out.set(rows.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
        return out;
    }
}
