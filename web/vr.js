// SPDX-License-Identifier: BSD-2-Clause
// The button of the headset, where the browser knows one. The scene begins at the view that the page shows.
'use strict';

let headset = null;             // while it shows the scene

async function offerHeadset() {
    const there = webgl && navigator.xr ? await navigator.xr.isSessionSupported('immersive-vr').catch(() => false) : false;
    $('vr').hidden = !there;
}

/** The directions and the centre of a camera: columns of its pose. */
function axesOf(camera) {
    const numbers = new DataView(camera.buffer);
    const column = i => [0, 1, 2].map(row => numbers.getFloat64(POSE + (4 * row + i) * FLOAT64, true));
    return { right: column(0), down: column(1), forward: column(2), centre: column(3) };
}

function leaveHeadset() {
    headset = null;
    chooseGpu();
    $('vr').setAttribute('aria-pressed', false);
    shownKey = '';
    wake();
}

async function toggleHeadset() {
    if (headset)
        return headset.end();
    if (!opened() || !webgl || webgl.lost)
        return null;
    const scene = {
        background: page.facts.background,
        filter: information.filter,
        image(direction) {
            view.call.view_tick(performance.now() / 1000);
            followSound();
            emitClock();
            requestSplats(view.call.view_time(), direction);
        },
        select: () => press(' '.charCodeAt(0)),
        end: leaveHeadset,
    };
    try {
        headset = await Headset.enter(webgl, new Place(page.facts, axesOf(cameraOf(1))), scene);
        chooseGpu();
        $('vr').setAttribute('aria-pressed', true);
    } catch (e) {
        say(`The headset does not start: ${e.message}`);
    }
    return null;
}

function listenToHeadset() {
    $('vr').addEventListener('click', toggleHeadset);
    if (navigator.xr && navigator.xr.addEventListener)
        navigator.xr.addEventListener('devicechange', offerHeadset);
    offerHeadset();
}
