// SPDX-License-Identifier: BSD-2-Clause

/** Codes of the library: see adcgs/status.h. */
export type AdcgsCode =
    'USAGE' | 'MEMORY' | 'IO' | 'DATA' | 'TRUNCATED' | 'UNSUPPORTED' | 'LIMIT' | 'FPENV' | 'INTERNAL';

export class AdcgsError extends Error {
    constructor(code: AdcgsCode, message: string);
    readonly code: AdcgsCode;
}

export type Vector = readonly [number, number, number];

/**
 * A pinhole camera. Its axes are right, down, forward (OpenCV). A point (X, Y, Z) of the camera is at the pixel
 * (fx X/Z + cx, fy Y/Z + cy); the first pixel covers 0 to 1.
 */
export interface PinholeCamera {
    name?: string;
    /** Pixels. */
    width: number;
    height: number;
    fx: number;
    fy: number;
    cx: number;
    cy: number;
    /** 12 numbers: a matrix of 3 rows and 4 columns, [R | c]. R is orthonormal, c the position in world units. */
    camToWorld: ArrayLike<number>;
    /** World units: nothing closer is shown. */
    near: number;
}

/** A camera that the clip stores. */
export interface StoredCamera extends Required<PinholeCamera> {
    /** Seconds at which it filmed; null if it has no time. */
    readonly time: number | null;
    /** Number of the filmed path that it is a key of; null if it is none. */
    readonly path: number | null;
}

/** A camera at a position that looks at a target, in world units. */
export interface LookAtCamera {
    position: Vector;
    /** By default the centre of the scene. */
    target?: Vector;
    /** By default that of the first view. */
    up?: Vector;
    /** Degrees, vertical; by default that of the first view. */
    fov?: number;
    near?: number;
    /** Pixels, for clip.frame(); by default those of the first view. */
    width?: number;
    height?: number;
}

/** 'home' is the first view that players show, a number or a name is a stored camera. */
export type Camera = 'home' | (string & {}) | number | PinholeCamera | LookAtCamera;

export interface Info {
    /** Seconds. timeEnd and duration are Infinity while the header of a live stream gives no end. */
    readonly timeStart: number;
    readonly timeEnd: number;
    readonly duration: number;
    /** Seconds: end of the part that can be shown now; -Infinity if there is none. */
    readonly available: number;
    readonly frameRate: number;
    readonly splats: number;
    readonly anchors: number;
    readonly staticAnchors: number;
    readonly weights: number;
    readonly segments: number;
    readonly layers: number;
    readonly tiers: number;
    readonly cameras: readonly StoredCamera[];
    /** 1 to 3: bounds of memory and time for decoding. */
    readonly level: number;
    /** Of the bitstream, and of the decoder. */
    readonly version: string;
    readonly library: string;
    /** Bytes by content; total is the number of bytes received. */
    readonly bytes: Readonly<Record<string, number>> & { readonly total: number };
    /** Whether the stream ended early. */
    readonly truncated: boolean;
    /** Red, green, blue behind the splats. */
    readonly background: Vector;
    /** world = origin + scale * scene. */
    readonly origin: Vector;
    readonly scale: number;
    /** Meaning of colours: 'sRGB', 'linear BT.709' or 'unknown'. */
    readonly color: string;
    /** Of the world: 'right-handed, y up', 'right-handed, z up', 'right-handed, y down' or 'unknown'. */
    readonly axes: string;
    /** Texts of the stream, not trusted: keys and values. */
    readonly metadata: readonly (readonly [string, string])[];
}

/** The visible splats at one time, in the stream's order. */
export interface Splats {
    readonly count: number;
    /** 3 numbers each: centre x, y, z in world units. */
    readonly positions: Float32Array;
    /** 3 numbers each: standard deviations along the splat's axes, in world units. */
    readonly scales: Float32Array;
    /** 4 numbers each: unit quaternion w, x, y, z, from the splat's axes to the world's. */
    readonly rotations: Float32Array;
    /** 3 numbers each: red, green, blue, 0 to 1, not clipped. */
    readonly colors: Float32Array;
    /** 1 number each: above 0, at most 0.99. */
    readonly opacities: Float32Array;
}

/** An exact image: its pixels are those of every conforming decoder. */
export interface Frame {
    readonly width: number;
    readonly height: number;
    /** Red, green, blue, alpha, rows from the top; new ImageData(data, width, height) takes it. */
    readonly data: Uint8ClampedArray<ArrayBuffer>;
    /** As adcgs-dec --md5 prints it. */
    readonly md5: string;
}

/** Events: progress, whenever a further part of the stream has arrived. */
export class Clip extends EventTarget {
    private constructor();
    /** The current knowledge: a new object after each progress event. */
    readonly info: Info;
    /** info.available. */
    readonly available: number;
    /** Resolves when some part can be shown; rejects if none ever can. */
    readonly playable: Promise<void>;
    readonly isPlayable: boolean;
    /** Resolves when the stream is complete; rejects with its failure. The part that arrived before it remains. */
    readonly ready: Promise<void>;
    /** Whether no more bytes will come. */
    readonly complete: boolean;
    readonly closed: boolean;
    /** time: seconds; outside the clip's range, its start or end. */
    splats(time: number): Splats;
    /**
     * Computes the exact image. Its size is the camera's unless given. In an image of another shape the whole view of the camera
     * stays visible ('contain', the default), or a part of it fills the image ('cover').
     */
    frame(camera: Camera | undefined, time: number,
          size?: { width?: number; height?: number; fit?: 'contain' | 'cover' }): Frame;
    /** Renders to the whole canvas, with WebGL2, or exactly if the canvas has a 2D context or there is no WebGL2. */
    render(canvas: HTMLCanvasElement | OffscreenCanvas, camera: Camera | undefined, time: number): void;
    /** Stops reading and frees the decoder. */
    close(): void;
}

export type Source = string | URL | Response | Blob | ArrayBuffer | ArrayBufferView<ArrayBuffer> | ReadableStream<Uint8Array>;
export type Wasm = string | URL | Response | ArrayBuffer | Uint8Array | Promise<Response | ArrayBuffer | Uint8Array>;

export interface OpenOptions {
    /** Ends the reading; open() and clip.ready reject with its reason. */
    signal?: AbortSignal;
    /** Another place of the decoder's module, or the module; by default the files next to this one. */
    wasm?: Wasm;
}

/** Opens a clip: resolves when its header has arrived. */
export function open(source: Source, options?: OpenOptions): Promise<Clip>;
