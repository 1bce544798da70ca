// SPDX-License-Identifier: BSD-2-Clause
import type { AdcgsError, Camera, Clip } from './adcgs.js';

/**
 * <adcgs-player>. Attributes: src, poster, autoplay, loop, controls, camera, time, wasm, aria-label. Events: loadedmetadata,
 * canplay, progress, play, pause, timeupdate, ended, error.
 */
export class AdcgsPlayer extends HTMLElement {
    src: string;
    poster: string;
    autoplay: boolean;
    loop: boolean;
    controls: boolean;
    /** The attribute: name or index of a stored camera, or home. */
    camera: string;
    /** Seconds of the clip's time, from clip.info.timeStart to clip.info.timeEnd. */
    currentTime: number;
    readonly duration: number;
    readonly paused: boolean;
    readonly ended: boolean;
    /** Names of the stored cameras. */
    readonly cameras: string[];
    readonly clip: Clip | null;
    readonly error: AdcgsError | null;
    play(): Promise<void>;
    pause(): void;
    load(): void;
    setCamera(camera: Camera): void;
}

declare global {
    interface HTMLElementTagNameMap {
        'adcgs-player': AdcgsPlayer;
    }
}
