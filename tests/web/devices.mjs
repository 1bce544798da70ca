// SPDX-License-Identifier: BSD-2-Clause
// The page with devices beyond screen and mouse: node devices.mjs chromium|firefox COMMAND FOLDER [full]; in the build folder.
// FOLDER has s.adcgs and sound.html, whose scene lasts from 0.1 to 1.01 s and whose sound begins at 0.1 s; the sound of deaf.html is
// damaged. Exits with 1 if something is wrong.
import { readFileSync } from 'node:fs';
import { at, browser, check, go, kind, run, runParts, same, urlOf } from './page_kit.mjs';

const WITHIN = 0.04;                            // seconds: the sound's largest distance from the image
const FRAME = 1 / 30;                           // seconds
const BEGIN = 0.1, LOWEST = 500, RISE = 4000;   // the sound of test_page.sh: Hz at its beginning, and Hz/s

/** Samples of the sound and of the image, at each of the browser's images for some seconds. */
const LISTEN = `
const listen = async seconds => {
    const tap = adcgs.sound.context.createAnalyser(), rows = [];
    tap.fftSize = 1024;
    tap.smoothingTimeConstant = 0;
    adcgs.sound.output.connect(tap);
    const levels = new Float32Array(tap.frequencyBinCount), hz = adcgs.sound.context.sampleRate / tap.fftSize;
    for (const end = performance.now() + 1000 * seconds; performance.now() < end;) {
        await new Promise(requestAnimationFrame);
        tap.getFloatFrequencyData(levels);
        const loudest = levels.indexOf(Math.max(...levels));
        rows.push({ image: adcgs.time, sound: adcgs.sound.time, hz: loudest * hz,
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

/** The sound follows the image: its own account of the time, and the pitch that is heard. */
function checkSound(rows) {
    const far = distances(rows, FRAME), most = Math.max(...far);
    check(far.length > 20 && most < WITHIN, `the sound is up to ${most} s from the image, in ${far.length} samples`);
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
        return listen(1.5);`));
    const got = await ask(`const bar = document.getElementById('time'), out = [];
        adcgs.pause(); await sleep(50); out.push(adcgs.sound.time);
        bar.value = 20; bar.dispatchEvent(new Event('input')); await sleep(50); out.push(adcgs.sound.time);
        adcgs.play(); await until(() => adcgs.sound.time !== null, 'sound after a seek'); const late = [adcgs.time, adcgs.sound.time];
        bar.value = 2; bar.dispatchEvent(new Event('input')); await until(() => adcgs.sound.time < 0.5, 'sound after another seek');
        const early = [adcgs.time, adcgs.sound.time];
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

await runParts([sound], 480, 360);
