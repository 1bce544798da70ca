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

/** Outside of the filmed region the image is darker; next to the filmed view there is none. */
export function showLimits(call, style) {
    const dark = Math.round(50 * call.view_outside()), x = 100 * call.view_inset(0), y = 100 * call.view_inset(1);
    style.filter = dark ? `brightness(${100 - dark}%)` : '';
    style.clipPath = x || y ? `inset(${y.toFixed(2)}% ${x.toFixed(2)}%)` : '';
}
