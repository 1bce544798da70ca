// SPDX-License-Identifier: BSD-2-Clause
// The page of a clip in a browser: node clip.mjs chromium|firefox COMMAND FOLDER; in the build folder. FOLDER has clip.adcgs and
// clip.html. Checks that the page plays, and that its frames are those of adcgs-dec; exits with 1 if not.
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { openBrowser } from './browser.mjs';

const FRAMES = 3, PATIENCE_MS = 60000;
const [kind, command, folder] = process.argv.slice(2);
const profile = join(folder, `profile-${kind}`);
const url = query => pathToFileURL(join(folder, 'clip.html')).href + query;
const until = `const until = async (what, why) => {
    for (const end = Date.now() + ${PATIENCE_MS}; !what(); await new Promise(done => setTimeout(done, 20)))
        if (Date.now() > end)
            throw new Error('no ' + why + ': ' + adcgs.state + ' ' + adcgs.message);
};`;

mkdirSync(profile);
const browser = await openBrowser(kind, command, profile, { width: 800, height: 600, flags: ['--enable-unsafe-swiftshader'] });
try {
    await browser.go(url('?autoplay=0'));
    const played = await browser.run(`${until}
        await until(() => window.adcgs && adcgs.state === 'complete' && adcgs.picture, 'image');
        const first = adcgs.view.call.view_frame();
        document.getElementById('exact').dispatchEvent(new KeyboardEvent('keydown', { key: ' ', bubbles: true }));
        await until(() => adcgs.view.call.view_playing() && adcgs.view.call.view_frame() !== first, 'other frame while playing');
        return adcgs.message;`);
    if (played)
        throw new Error(`message of the page: ${played}`);
    if (process.env.ADCGS_SHOTS)
        await browser.shot(join(process.env.ADCGS_SHOTS, `${kind}-clip.png`));
    await browser.go(url(`?md5=${FRAMES}`));
    const got = await browser.run(`${until}
        await until(() => document.querySelector('#digests')?.dataset.done, 'digests');
        return document.getElementById('digests').textContent.trim();`);
    const expected = execFileSync('./adcgs-dec', ['--quiet', '--md5', join(folder, 'clip.adcgs')], { encoding: 'utf8' }).split('\n');
    if (got !== expected.slice(0, FRAMES).join('\n'))
        throw new Error(`frames:\n${got}\nexpected\n${expected.slice(0, FRAMES).join('\n')}`);
} catch (error) {
    console.log(`FAILED: ${kind}: ${error.message}`);
    process.exitCode = 1;
} finally {
    await browser.close();
}
