// SPDX-License-Identifier: BSD-2-Clause
// The inside of <adcgs-player>. Pages style its parts: canvas, poster, message, controls, play, time, clock.

export const CONTENT = `<style>
:host { display: inline-block; position: relative; width: 480px; height: 270px; overflow: hidden; background: #000; }
:host([hidden]) { display: none; }
canvas, img { position: absolute; inset: 0; width: 100%; height: 100%; }
canvas { touch-action: pan-y; cursor: grab; }
canvas:focus-visible { outline: 2px solid #fff; outline-offset: -2px; }
img { object-fit: cover; pointer-events: none; }
[hidden] { display: none !important; }
[part=controls] { position: absolute; inset: auto 0 0; display: flex; gap: 8px; align-items: center; padding: 6px 10px;
    color: #fff; background: #0009; font: 13px system-ui, sans-serif; }
button { width: 32px; height: 28px; border: 0; color: inherit; background: none; font-size: 15px; cursor: pointer; }
input { flex: 1; min-width: 0; }
[part=message] { position: absolute; inset: auto 0 50%; text-align: center; color: #fff; font: 14px system-ui, sans-serif; }
</style>
<canvas part="canvas" tabindex="0" role="img"></canvas>
<img part="poster" alt="" hidden>
<div part="message" role="alert" hidden></div>
<div part="controls" role="group" aria-label="Playback" hidden>
<button part="play" type="button" aria-label="Play"></button>
<input part="time" type="range" min="0" step="1" value="0" aria-label="Time">
<output part="clock"></output>
</div>`;
