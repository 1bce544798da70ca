// SPDX-License-Identifier: BSD-2-Clause
// Images on a canvas: with WebGL2 as in the page, or exact ones where WebGL2 is missing.
import { AdcgsError } from './error.js';
import { CAMERA } from './engine.js';
import { Gpu } from './gpu.js';

const TURN = 1e-4; // change of the direction that sorts the splats again

const painters = new WeakMap(); // canvas: its Gpu, and the splats that it has

function painterOf(canvas) {
    if (!painters.has(canvas)) {
        const painter = { gpu: null, clip: null, time: NaN, generation: -1, direction: [0, 0, 0], context: null };
        try {
            painter.gpu = new Gpu(canvas);
        } catch (e) {
            painter.context = canvas.getContext('2d');
            if (!painter.context)
                throw new AdcgsError('UNSUPPORTED', `the canvas gives neither WebGL2 nor a 2D context: ${e.message}`);
        }
        painters.set(canvas, painter);
    }
    return painters.get(canvas);
}

/** Whether the canvas renders with WebGL2: true, false, or null if its context was lost. */
export function isFast(canvas) {
    const { gpu } = painterOf(canvas);
    return gpu && gpu.gl.isContextLost() ? null : gpu !== null;
}

/** Whether the canvas still renders its last image. */
export function isBusy(canvas) {
    const { gpu } = painterOf(canvas);
    return gpu !== null && !gpu.gl.isContextLost() && gpu.busy();
}

/** Gives the canvas's context back. */
export function release(canvas) {
    painters.get(canvas)?.gpu?.gl.getExtension('WEBGL_lose_context')?.loseContext();
    painters.delete(canvas);
}

/** Splats and their order, where the GPU has others. */
function update(painter, clip, time, direction) {
    const isOld = painter.clip !== clip || painter.time !== time || painter.generation !== clip.generation;
    if (isOld) {
        const { count, texels } = clip.texels(time);
        painter.gpu.take(texels, count);
        painter.generation = clip.generation;
        Object.assign(painter, { clip, time });
    }
    if (isOld || direction.some((d, i) => Math.abs(d - painter.direction[i]) > TURN)) {
        painter.gpu.sort(clip.order(direction, painter.gpu.n));
        painter.direction = direction;
    }
}

/** Renders a clip at a time through a camera, given by its bytes. */
export function paint(clip, canvas, camera, time) {
    const painter = painterOf(canvas), numbers = new DataView(camera.buffer);
    const width = numbers.getInt32(CAMERA.WIDTH, true), height = numbers.getInt32(CAMERA.HEIGHT, true);
    if (!painter.gpu) {
        const { data } = clip.exact(camera, time);
        Object.assign(canvas, { width, height });
        painter.context.putImageData(new ImageData(data, width, height), 0, 0);
        return;
    }
    if (painter.gpu.gl.isContextLost())
        throw new AdcgsError('UNSUPPORTED', 'the canvas lost its WebGL2 context');
    const uniforms = clip.use([camera], at => {
        const numbersAt = clip.engine.call.page_uniforms(at);
        return numbersAt ? clip.engine.floats(numbersAt, 21) : null;
    });
    if (!uniforms)
        throw AdcgsError.from(clip.engine, -1);
    update(painter, clip, time, CAMERA.FORWARD.map(at => numbers.getFloat64(at, true)));
    painter.gpu.draw(uniforms, width, height, clip.info.background, clip.engine.call.page_filter());
}
