// SPDX-License-Identifier: BSD-2-Clause
// The page with sound, headset and fingers: node devices.mjs chromium|firefox COMMAND FOLDER [full]; in the build folder.
// FOLDER has s.adcgs, share.html (with it) and sound.html, whose scene lasts from 0.1 to 1.01 s, and its sound begins at 0.1 s. The
// sound of deaf.html is damaged. Exits with 1 if something is wrong.
import { readFileSync } from 'node:fs';
import { at, browser, check, full, go, kind, restart, run, runParts, same, samePicture, shot, urlOf } from './page_kit.mjs';

const STREAM = `${process.env.srcdir || '.'}/conformance/vectors/good-seq-gaps.adcgs`;
const WITHIN = 0.04;                            // seconds: the sound's largest distance from the image
const FRAME = 1 / 30;                           // seconds
const BEGIN = 0.1, LOWEST = 500, RISE = 4000;   // the sound of test_page.sh: Hz at its beginning, and Hz/s

/** Samples of the sound and of the image, at each of the browser's images for some seconds. */
const LISTEN = `
/** The time of the frame to show now, and of the sound. */
const both = () => {
    adcgs.view.call.view_tick(performance.now() / 1000);
    return [adcgs.time, adcgs.sound.time];
};
const listen = async seconds => {
    const tap = adcgs.sound.context.createAnalyser(), rows = [];
    tap.fftSize = 1024;
    tap.smoothingTimeConstant = 0;
    adcgs.sound.output.connect(tap);
    const levels = new Float32Array(tap.frequencyBinCount), hz = adcgs.sound.context.sampleRate / tap.fftSize;
    for (const end = performance.now() + 1000 * seconds; performance.now() < end;) {
        await new Promise(requestAnimationFrame);
        tap.getFloatFrequencyData(levels);
        const [image, sound] = both(), loudest = levels.indexOf(Math.max(...levels));
        rows.push({ image, sound, hz: loudest * hz,
                    ahead: adcgs.sound.latency - tap.fftSize / 2 / adcgs.sound.context.sampleRate });
    }
    adcgs.sound.output.disconnect(tap);
    return rows;
};`;
const ask = script => run(LISTEN + script);

/** Distances of the sound from the interval of the frame that is shown, without the images after a jump. */
function distances(rows, frame) {
    const out = [];
    for (let i = 3, calm = 0; i < rows.length; i++) {
        calm = rows[i].image < rows[i - 1].image || rows[i].sound === null ? 0 : calm + 1;
        if (calm > 3)
            out.push(Math.max(rows[i].image - rows[i].sound, rows[i].sound - rows[i].image - frame, 0));
    }
    return out;
}

/** The sound follows the image: its own account of the time, and the pitch that is heard. Medians: a busy machine delays images. */
function checkSound(rows) {
    const far = distances(rows, FRAME).sort((a, b) => a - b), middle = far[far.length >> 1];
    check(far.length > 20 && middle < WITHIN, `the sound is ${middle} s from the image, median of ${far.length} samples`);
    const heard = rows.filter(row => row.sound > BEGIN + 0.1)
        .map(row => Math.abs(BEGIN + (row.hz - LOWEST) / RISE - (row.sound + row.ahead))).sort((a, b) => a - b);
    check(heard.length > 20 && heard[heard.length >> 1] < WITHIN,
          `half of ${heard.length} pitches are ${heard[heard.length >> 1]} s from the sound's account`);
}

async function sound() {
    await go(urlOf('sound.html', '?autoplay=0'));
    const silent = await run(`await settled(); const button = document.getElementById('mute');
        return [button.checkVisibility(), button.getAttribute('aria-pressed'), adcgs.muted, adcgs.sound.context];`);
    same(silent, [true, 'false', true, null], 'a button, not pressed; muted; no sound is prepared');
    await browser.click('#mute');
    if (await run(`await until(() => adcgs.sound.buffer, 'decoded sound');
        for (let i = 0; i < 60 && adcgs.sound.context.state !== 'running'; i++)
            await sleep(50);
        return adcgs.sound.context.state !== 'running';`)) {
        console.log(`skipped: the sound in ${kind}: no sound device; pulseaudio would be one`);
        return;
    }
    const paused = await run(`return [document.getElementById('mute').getAttribute('aria-pressed'), adcgs.muted, adcgs.sound.time];`);
    same(paused, ['true', false, null], 'pressed, not muted, silent in a pause');
    checkSound(await ask(`adcgs.play(); await until(() => adcgs.sound.time !== null, 'sound while playing');
        return listen(1);`));
    const got = await ask(`const bar = document.getElementById('time'), out = [];
        adcgs.pause(); await sleep(50); out.push(adcgs.sound.time);
        bar.value = 20; bar.dispatchEvent(new Event('input')); await sleep(50); out.push(adcgs.sound.time);
        adcgs.play(); await until(() => adcgs.sound.time !== null, 'sound after a seek'); const late = both();
        bar.value = 2; bar.dispatchEvent(new Event('input')); await until(() => adcgs.sound.time !== null && adcgs.sound.time < 0.5, 'sound after another seek');
        const early = both();
        key('.'); await sleep(50); out.push(adcgs.sound.time);
        key(','); await until(() => adcgs.sound.time !== null, 'sound at its own speed');
        key('m'); await sleep(50); out.push(adcgs.sound.time, adcgs.muted, document.getElementById('mute').getAttribute('aria-pressed'));
        key('m'); await until(() => adcgs.sound.time !== null, 'sound again');
        adcgs.setMuted(true); out.push(adcgs.sound.time);
        return { out, late, early };`);
    same(got.out, [null, null, null, null, true, 'false', null], 'silent in a pause, after a seek in it, twice as fast, and muted');
    for (const [image, heard] of [got.late, got.early])
        check(heard - image > -WITHIN && heard - image < FRAME + WITHIN, `after a seek: sound ${heard}, image ${image}`);
    const other = await run(`drop('${readFileSync(at('s.adcgs')).toString('base64')}', 's.adcgs'); await sleep(50); await settled();
        return [adcgs.sound, document.getElementById('mute').hidden];`);
    same(other, [null, true], 'another scene has no sound');
    await go(urlOf('deaf.html', '?autoplay=0'));
    await run('await settled();');
    await browser.click('#mute');
    const deaf = await run(`await until(() => adcgs.message, 'message'); return [adcgs.message, document.getElementById('mute').hidden, adcgs.state];`);
    same(deaf, ['This browser cannot play the sound of this scene', true, 'complete'], 'a sound that no browser decodes');
}

/** Reads the image of each eye within a frame of the session: the mean place of its light. */
const EYES = `
const eyes = () => new Promise((resolve, reject) => {
    const { session, layer, gpu } = adcgs.headset, gl = gpu.gl;
    const look = (time, frame) => {
        try {
            const pose = frame.getViewerPose(adcgs.headset.space), sums = pose.views.map(eye => {
                const { x, y, width, height } = layer.getViewport(eye), rgba = new Uint8Array(4 * width * height);
                gl.bindFramebuffer(gl.FRAMEBUFFER, layer.framebuffer);
                gl.readPixels(x, y, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
                const sum = [0, 0, 0];
                for (let i = 0; i < width * height; i++) {
                    const light = [0, 1, 2].reduce((sum, c) => sum + Math.abs(rgba[4 * i + c] - rgba[c]), 0);
                    sum[0] += light;
                    sum[1] += light * (i % width + 0.5);
                    sum[2] += light * (Math.floor(i / width) + 0.5);
                }
                return { x: sum[1] / sum[0], y: sum[2] / sum[0], light: sum[0] / (width * height), width,
                         focal: eye.projectionMatrix[0] * width / 2, eye: eye.eye };
            });
            resolve({ sums, n: gpu.n, sorted: gpu.sorted });
        } catch (e) { reject(e); }
    };
    session.requestAnimationFrame(look);
});
`;

/** The place of an eye: with the pose and the lens of the page's camera, the shader's numbers are those of the decoder. */
async function eye() {
    await go(urlOf('share.html', '?autoplay=0'));
    const got = await run(`await settled();
        if (typeof Place === 'undefined')
            return null;
        const seen = [];
        for (const [axes, units, angle] of [['right-handed, z up', 'metre', 0], ['right-handed, y down', 'unknown', 1], ['unknown', 'unknown', -2]]) {
            adcgs.setCamera({ position: [1 + angle, -2.5, 1.4], target: [0.2, 0.1, 0.3], up: [0.1, 0, 1] });
            const camera = cameraOf(1), numbers = new DataView(camera.buffer), axis = axesOf(camera);
            const place = new Place({ ...adcgs.facts, axes, units }, axis), width = numbers.getInt32(0, true), height = numbers.getInt32(4, true);
            const want = [...view.floats(view.call.view_uniforms(1), 21)], [fx, fy, cx, cy] = want.slice(12, 16);
            const inside = v => [place.right, place.up, place.back].map(a => dot(a, v));
            const pose = new Float32Array(16), projection = new Float32Array(16);
            [axis.right, axis.down.map(x => -x), axis.forward.map(x => -x)].forEach((v, i) => pose.set(inside(v), 4 * i));
            pose[15] = 1;
            projection.set([2 * fx / width, 0, 0, 0, 0, 2 * fy / height, 0, 0, 1 - 2 * cx / width, 2 * cy / height - 1, -1, -1]);
            const off = () => [...place.uniforms(pose, projection, width, height)].map((x, i) => i === 16 ? 0 : Math.abs(x - want[i]) / (1 + Math.abs(want[i])));
            seen.push(Math.max(...off()));
            place.turn(pose, 0.7);
            place.turn(pose, -0.7);
            place.walk(pose, 1, 2);
            const far = Math.max(...off());
            place.walk(pose, -1, -2);
            seen.push(Math.max(...off()), far > 0.01, place.metre > 0 && (units !== 'metre' || place.metre === 1));
        }
        return seen;`);
    if (!got) {
        console.log(`skipped: the eyes of a headset in ${kind}: tests cannot see the page's classes there`);
        return;
    }
    for (let i = 0; i < got.length; i += 4)
        check(got[i] < 1e-5 && got[i + 1] < 1e-5 && got[i + 2] && got[i + 3], `the eye's numbers, set ${i / 4}: ${got.slice(i, i + 4)}`);
    same(got.length, 12, 'sets of numbers');
}

const EYES_APART = 0.64, AWAY = 6;              // metres; the middle of a scene without units is 2 m from the first view

/** A headset, of the emulator iwer (npm): ADCGS_IWER names its file build/iwer.min.js. */
async function headset() {
    const emulator = process.env.ADCGS_IWER;
    if (!emulator) {
        console.log('skipped: a headset: no emulator; ADCGS_IWER may name build/iwer.min.js of iwer (npm)');
        return;
    }
    await go(urlOf('sound.html', '?autoplay=0'));
    const without = await run(`await settled(); return [document.getElementById('vr').hidden, adcgs.gpu ? '' : adcgs.notes.join()];`);
    if (without[1]) {
        console.log(`skipped: a headset in ${kind}: ${without[1]}`);
        return;
    }
    same(without[0], true, 'no button without a headset');
    await run(`${readFileSync(emulator, 'utf8')}; window.IWER = globalThis.IWER || this.IWER;`);
    await run(`const device = window.device = new IWER.XRDevice(IWER.metaQuest3);
        device.installRuntime({ polyfillLayers: false, forceInstall: true }); device.stereoEnabled = true; device.ipd = ${EYES_APART};
        device.position.set(0, 0, ${AWAY});
        await adcgs.offerHeadset();`);
    same(await run(`return document.getElementById('vr').checkVisibility();`), true, 'a button with a headset');
    await browser.click('#vr');
    const got = await run(`${EYES}
        await until(() => adcgs.headset && adcgs.gpu.n && adcgs.gpu.sorted === adcgs.gpu.n, 'session with splats');
        const { left, right } = device.controllers, place = adcgs.headset.place, frames = n => new Promise(done => {
            const next = () => n-- ? adcgs.headset.session.requestAnimationFrame(next) : done();
            next();
        });
        await frames(3);
        const first = await eyes(), pressed = document.getElementById('vr').getAttribute('aria-pressed');
        left.updateAxes('thumbstick', 0, -1);
        await until(() => place.walked[2] < -2, 'walk forward');
        left.updateAxes('thumbstick', 0, 0);
        await frames(3);
        const walked = [...place.walked], near = await eyes();
        right.updateAxes('thumbstick', 1, 0);
        await until(() => place.angle, 'turn');
        await frames(5);
        const turns = place.angle;
        right.updateAxes('thumbstick', 0, 0);
        right.updateButtonValue('trigger', 1); await frames(3); right.updateButtonValue('trigger', 0);
        await until(() => adcgs.playing, 'playing by the trigger');
        await until(() => adcgs.view.call.view_frame() > 2, 'frames while playing');
        const sorts = adcgs.fast.sortMs !== undefined;
        adcgs.pause();
        const n = adcgs.pictures;
        document.getElementById('vr').click();
        await until(() => !adcgs.headset && adcgs.pictures > n, 'exact image after the session');
        await settled();
        return { first, near, walked, turns, pressed, sorts, after: document.getElementById('vr').getAttribute('aria-pressed'), ...report() };`);
    same([got.pressed, got.after, got.sorts], ['true', 'false', true], 'aria-pressed in the session and after it; sorted splats');
    samePicture(got.picture, STREAM, 'the exact image after the session');
    check(Math.abs(got.walked[0]) + Math.abs(got.walked[1]) < 1e-6, `a walk forward, to ${got.walked}`);
    check(Math.abs(got.turns + Math.PI / 6) < 1e-6, `one turn to the right: ${got.turns}`);
    for (const [{ sums: [left, right] }, metres] of [[got.first, AWAY + 2], [got.near, AWAY + 2 + got.walked[2]]]) {
        const expected = left.focal * EYES_APART / metres;
        check(left.light > 0 && Math.abs(left.x - right.x - expected) < 0.08 * expected && Math.abs(left.y - right.y) < 0.05 * expected,
              `parallax of ${left.x - right.x} pixels at ${metres} m, expected ${expected}; rows ${left.y}, ${right.y}`);
    }
}

/** The stick of a phone: its place in both orientations, flight, turns, and the way back. */
async function stick() {
    await go(urlOf('sound.html', '?autoplay=0'));
    same(await run(`await settled(); return document.getElementById('stick').checkVisibility();`), false, 'a stick with a mouse');
    for (const [width, height] of full ? [[844, 390], [390, 844]] : [[390, 844]]) {
        await restart(width, height, { phone: true });
        await go(urlOf('sound.html', '?autoplay=0'));
        const got = await run(`await settled();
            const box = id => document.getElementById(id).getBoundingClientRect(), stick = box('stick'), knob = box('stick').width / 2;
            const over = id => { const b = box(id); return b.width > 0 && stick.left < b.right && b.left < stick.right &&
                stick.top < b.bottom && b.top < stick.bottom; };
            return { seen: document.getElementById('stick').checkVisibility(), over: ['time', 'buttons', 'hint', 'card'].filter(over),
                     inside: stick.left >= 0 && stick.top >= 0 && stick.bottom <= innerHeight && stick.right < innerWidth / 2,
                     small: [...document.querySelectorAll('#buttons button, #stick, #stick i')].filter(e => e.checkVisibility() &&
                         (e.getBoundingClientRect().width < 44 || e.getBoundingClientRect().height < 44)).map(e => e.id),
                     wide: document.documentElement.scrollWidth > innerWidth };`);
        same(got, { seen: true, over: [], inside: true, small: [], wide: false }, `the stick at ${width}x${height}`);
        await shot(`stick-${width}x${height}`);
    }
    const got = await run(`
        const thumb = (type, x, y) => { const b = document.getElementById('stick').getBoundingClientRect();
            document.getElementById('stick').dispatchEvent(new PointerEvent(type, { pointerId: 7, pointerType: 'touch', bubbles: true,
                clientX: b.left + b.width * (1 + x) / 2, clientY: b.top + b.height * (1 + y) / 2 })); };
        const pose = () => { const n = new DataView(adcgs.view.copy(adcgs.view.call.view_camera(1), 136).buffer);
            return { at: [64, 96, 128].map(i => n.getFloat64(i, true)), ahead: [56, 88, 120].map(i => n.getFloat64(i, true)) }; };
        const flying = () => adcgs.view.call.view_flying() === 1, seen = () => document.getElementById('stick').classList.contains('flying');
        const first = pose();
        thumb('pointerdown', 0, 0); thumb('pointermove', 0.05, -0.9);
        await until(() => { const { at } = pose(); return Math.hypot(...at.map((x, i) => x - first.at[i])) > 0.05; }, 'flight');
        const flown = pose(), during = [flying(), seen(), adcgs.view.text(adcgs.view.call.view_message()) !== document.getElementById('message').textContent];
        const pictures = () => adcgs.fast.drawMs || adcgs.pictures, moved = pictures();
        pointer('pointerdown', 300, 300, 8, 'touch'); pointer('pointermove', 340, 310, 8, 'touch'); pointer('pointerup', 340, 310, 8, 'touch');
        const turned = pose();
        thumb('pointerup', 0.05, -0.9); await sleep(100);
        const n = adcgs.pictures; await until(() => adcgs.drawn.exact && adcgs.picture.generation === adcgs.generation, 'exact image');
        const rest = pose(); await sleep(200); const still = pose(), after = flying();
        thumb('pointerdown', 0, 0); thumb('pointerup', 0, 0); await sleep(100);
        return { first, flown, turned, rest, still, during, after, orbits: !flying() && !seen() };`);
    const way = got.flown.at.map((x, i) => x - got.first.at[i]), length = Math.hypot(...way);
    check(way.reduce((sum, x, i) => sum + x * got.first.ahead[i], 0) > 0.999 * length, `a flight ahead: ${way}`);
    check(Math.hypot(...got.turned.ahead.map((x, i) => x - got.flown.ahead[i])) > 0.01, 'a drag turns while the thumb flies');
    same([got.still.at, got.during, got.after, got.orbits], [got.rest.at, [true, true, true], true, true],
         'at rest without the thumb; flying, shown, no message about keys; flying until a tap');
}

await runParts([sound, eye, headset, stick], 480, 360);
