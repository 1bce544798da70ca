// SPDX-License-Identifier: BSD-2-Clause
import type { BufferGeometry, Material, Mesh } from 'three';
import type { Clip, OpenOptions, Source } from './adcgs.js';

/**
 * A clip as an object of three.js, for WebGLRenderer and PerspectiveCamera, also in WebXR. Its splats are sorted for the camera
 * in use, tested against the depth of opaque objects, and have the clip's own colours: no light, no tone mapping.
 */
export class AdcgsMesh extends Mesh<BufferGeometry, Material> {
    constructor(clip: Clip);
    static load(source: Source, options?: OpenOptions): Promise<AdcgsMesh>;
    readonly isAdcgsMesh: true;
    readonly clip: Clip;
    /** Seconds of the clip's time: the next image shows it. */
    time: number;
    /** Frees the resources of the GPU. The clip stays open. */
    dispose(): void;
}
