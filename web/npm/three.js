// SPDX-License-Identifier: BSD-2-Clause
// AdcgsMesh: a clip as an object of three.js, for WebGLRenderer and perspective cameras. The shaders are those of the page.
import {
    DataTexture, DoubleSide, FloatType, GLSL3, InstancedBufferGeometry, BufferAttribute, Matrix3, Matrix4, Mesh,
    NearestFilter, NormalBlending, RawShaderMaterial, RedIntegerFormat, RGBAFormat, UnsignedIntType, Vector2, Vector3, Vector4,
} from 'three';
import { FRAGMENT, VERTEX } from './gpu.js';
import { open } from './adcgs.js';

const WIDTH = 1024;             // splats in a row of the textures
const TEXELS = 4;               // of a splat in the texture of splats
const TURN = 1e-4;              // change of the direction that sorts the splats again
const MARGIN = 0.15;            // of the image, around it: where the projection of footprints is exact (spec, "View")

/** Upright in three.js, whose y axis points up: turns about the x axis. */
const TURNS = { 'right-handed, y down': Math.PI, 'right-handed, z up': -Math.PI / 2 };

/** The page's shader, with the order of the splats in a texture: three.js uploads textures after onBeforeRender(). */
function vertexShader() {
    const [first, rest] = VERTEX.split('in uint index;\n');
    return `${first.replace(/^#version.*\n/, '')}uniform highp usampler2D order;
#define index texelFetch(order, ivec2(gl_InstanceID % ${WIDTH}, gl_InstanceID / ${WIDTH}), 0).x
${rest}`;
}

function makeMaterial() {
    const numbers = { size: new Vector2(), rotation: new Matrix3(), translation: new Vector3(), lens: new Vector4(),
                      limits: new Vector4(), depth: new Vector2(), nearest: 0, screen: 0, splats: null, order: null };
    return new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: vertexShader(),
        fragmentShader: FRAGMENT.replace(/^#version.*\n/, ''),
        uniforms: Object.fromEntries(Object.entries(numbers).map(([name, value]) => [name, { value }])),
        blending: NormalBlending, premultipliedAlpha: true, transparent: true, depthWrite: false, side: DoubleSide,
    });
}

function makeGeometry() {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('corner', new BufferAttribute(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2));
    geometry.setIndex([0, 1, 2, 2, 1, 3]);
    geometry.instanceCount = 0;
    return geometry;
}

function makeTexture(data, width, rows, format, type, internalFormat) {
    const texture = new DataTexture(data, width, rows, format, type);
    texture.internalFormat = internalFormat;
    texture.minFilter = texture.magFilter = NearestFilter;
    return texture;
}

export class AdcgsMesh extends Mesh {
    #time = 0;
    #rows = 0;                          // of the textures
    #count = 0;                         // splats in them
    #packed = { time: NaN, generation: -1 };
    #direction = new Vector3();         // of the order

    /** A mesh of an open clip, turned so that the clip's up is that of three.js. Its units are the clip's world units. */
    constructor(clip) {
        super(makeGeometry(), makeMaterial());
        this.clip = clip;
        this.isAdcgsMesh = true;
        this.frustumCulled = false;
        this.#time = clip.info.timeStart;
        this.rotation.x = TURNS[clip.info.axes] ?? 0;
    }

    /** Opens a clip and waits for its first part. Arguments as open(). */
    static async load(source, options) {
        const clip = await open(source, options);
        await clip.playable;
        return new AdcgsMesh(clip);
    }

    /** Seconds of the clip's time. */
    get time() { return this.#time; }
    set time(seconds) { this.#time = Number(seconds); }

    raycast() {
        // Quads that face the camera have no surface to hit.
    }

    dispose() {
        const { splats, order } = this.material.uniforms;
        splats.value?.dispose();
        order.value?.dispose();
        this.material.dispose();
        this.geometry.dispose();
        this.#rows = this.#count = 0;
        this.#packed.time = NaN;
    }

    #reserve(count) {
        const { splats, order } = this.material.uniforms;
        if (count <= this.#rows * WIDTH)
            return;
        splats.value?.dispose();
        order.value?.dispose();
        this.#rows = Math.ceil(1.2 * count / WIDTH); // their number changes with time
        const room = this.#rows * WIDTH;
        splats.value = makeTexture(new Float32Array(4 * TEXELS * room), TEXELS * WIDTH, this.#rows, RGBAFormat, FloatType,
                                   'RGBA32F');
        order.value = makeTexture(new Uint32Array(room), WIDTH, this.#rows, RedIntegerFormat, UnsignedIntType, 'R32UI');
    }

    #pack() {
        const { clip } = this, { splats } = this.material.uniforms;
        const { count, texels } = clip.texels(this.#time);
        this.#reserve(count);
        this.#count = count;
        if (count) {
            splats.value.image.data.set(texels);
            splats.value.needsUpdate = true;
        }
        this.#packed = { time: this.#time, generation: clip.generation };
    }

    /** direction: of the view, in the clip's scene. */
    #sort(direction) {
        const { order } = this.material.uniforms;
        if (this.#count) {
            order.value.image.data.set(this.clip.order(direction.toArray(), this.#count));
            order.value.needsUpdate = true;
        }
        this.#direction.copy(direction);
    }

    /** From the clip's scene to the camera, whose axes are right, down, forward. */
    #sceneToCamera(camera) {
        const { origin, scale } = this.clip.info;
        const scene = new Matrix4().makeTranslation(...origin).multiply(new Matrix4().makeScale(scale, scale, scale));
        return new Matrix4().makeScale(1, -1, -1).multiply(camera.matrixWorldInverse).multiply(this.matrixWorld).multiply(scene);
    }

    #setUniforms(matrix, camera, width, height) {
        const u = this.material.uniforms, p = camera.projectionMatrix.elements;
        const fx = p[0] * width / 2, fy = p[5] * height / 2, cx = (1 - p[8]) * width / 2, cy = (1 + p[9]) * height / 2;
        u.size.value.set(width, height);
        u.rotation.value.setFromMatrix4(matrix);
        u.translation.value.setFromMatrixPosition(matrix);
        u.lens.value.set(fx, fy, cx, cy);
        u.limits.value.set((-cx - MARGIN * width) / fx, (width - cx + MARGIN * width) / fx,
                           (-cy - MARGIN * height) / fy, (height - cy + MARGIN * height) / fy);
        u.nearest.value = camera.near;
        u.depth.value.set(-p[10], p[14]);
        u.screen.value = this.clip.engine.call.page_filter();
        this.material.uniformsNeedUpdate = true;
    }

    onBeforeRender(renderer, scene, camera) {
        const { clip } = this;
        this.geometry.instanceCount = 0;
        if (clip.closed || !clip.isPlayable || !camera.isPerspectiveCamera)
            return;
        const isOld = this.#packed.time !== this.#time || this.#packed.generation !== clip.generation;
        if (isOld)
            this.#pack();
        const viewport = camera.viewport ?? renderer.getCurrentViewport(new Vector4());
        const matrix = this.#sceneToCamera(camera), e = matrix.elements;
        const direction = new Vector3(e[2], e[6], e[10]).normalize();
        if (isOld || direction.distanceTo(this.#direction) > TURN)
            this.#sort(direction);
        this.#setUniforms(matrix, camera, viewport.z, viewport.w);
        this.geometry.instanceCount = this.#count;
    }
}
