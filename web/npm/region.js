// SPDX-License-Identifier: BSD-2-Clause
// The centre of an orbit, and the limits of the filmed region.

/** The decoder finds the point under a place of the image, if the view asks for it: the new centre of the orbit. */
export function findPivot(clip, call) {
    const number = call.view_pivot_wanted();
    if (!number)
        return;
    const camera = clip.engine.copy(call.view_camera(1), call.page_camera_size());
    const at = clip.use([camera], c => call.page_pivot(c, call.view_time(), call.view_pivot_at(0), call.view_pivot_at(1)));
    if (at)
        call.view_pivot(number, ...new Float64Array(clip.engine.copy(at, 24).buffer));
}

export { styleLimits } from './limits.js';
