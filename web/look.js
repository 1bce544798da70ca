// SPDX-License-Identifier: BSD-2-Clause
// Cameras that look at a point, for the page and the npm package.
'use strict';

/** The pose of a camera at a place with a target in the middle of its image, row by row. fail(why) throws. */
function poseLookingAt(place, target, up, fail) {
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const unit = (a, why) => {
        const length = Math.hypot(...a);
        return length > 0 && isFinite(length) ? a.map(x => x / length) : fail(why);
    };
    const forward = unit([0, 1, 2].map(i => target[i] - place[i]), 'position and target are the same');
    const right = unit(cross(forward, up), 'it looks along its up direction'), down = cross(forward, right);
    return [0, 1, 2].flatMap(row => [right[row], down[row], forward[row], place[row]]);
}
