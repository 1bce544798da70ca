// SPDX-License-Identifier: BSD-2-Clause
// The limits of the filmed region, on the canvases of the page and of the npm package.
'use strict';

/** Outside of the filmed region the image is darker; next to the filmed view there is none. */
function styleLimits(call, canvases) {
    const dark = Math.round(50 * call.view_outside()), x = 100 * call.view_inset(0), y = 100 * call.view_inset(1);
    for (const { style } of canvases) {
        style.filter = dark ? `brightness(${100 - dark}%)` : '';
        style.clipPath = x || y ? `inset(${y.toFixed(2)}% ${x.toFixed(2)}%)` : '';
    }
}
