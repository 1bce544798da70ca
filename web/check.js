// SPDX-License-Identifier: BSD-2-Clause
// ?md5=N: list the MD5 of the first N frames of the first view at its own size, as `adcgs-dec --md5` does. Comparing the two
// lists shows whether a browser follows the specification.
'use strict';

function once(condition) {
    return new Promise(resolve => {
        const look = () => condition() ? resolve() : setTimeout(look, 10);
        look();
    });
}

async function listDigests(frames) {
    const list = document.body.appendChild(element('pre'));
    list.id = 'digests';
    await once(() => page.state === 'complete' || page.state === 'failed');
    if (page.state === 'complete') {
        await once(() => page.picture && !drawing);
        page.listing = true;
        const facts = page.facts, camera = information.home;
        for (let i = 0; i < frames; i++) {
            const time = facts.time_start + i / facts.frame_rate, before = page.pictures;
            worker.postMessage({ kind: 'draw', camera: camera.slice(), time, tiers: 0, digest: true, exact: true });
            await once(() => page.pictures > before);
            list.append(page.picture.digest + '\n');
        }
        page.listing = false;
    }
    list.dataset.done = page.state;
}
