// SPDX-License-Identifier: BSD-2-Clause
// The examples of the npm package in a browser, compared with the programs: node npm_browser.mjs chromium|firefox COMMAND
// FOLDER; in the build folder. FOLDER has s.adcgs and site/ with the folders player/dist and three/dist that Vite made. Each has
// scene.adcgs, which is s.adcgs, and zeros.adcgs; site/plain has the package and index.html. Prints the differences; exits with 1
// if there are any.
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname } from 'node:path';
import { at, browser, check, kind, runParts, same, samePicture, shot } from './page_kit.mjs';

const LEAST_DB = 38; // the GPU's image against the exact one, at least: 38.4 where a small view is enlarged to the window
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm' };

const HELPERS = `
const until = async (condition, title) => {
    for (const end = Date.now() + 30000; Date.now() < end;) {
        const value = condition();
        if (value)
            return value;
        await new Promise(done => setTimeout(done, 20));
    }
    throw new Error('no ' + title + ': ' + (document.querySelector('#state')?.textContent ?? ''));
};
const psnr = (a, b) => { // over red, green, blue
    let sum = 0;
    for (let i = 0; i < a.length; i++)
        sum += i % 4 < 3 ? (a[i] - b[i]) ** 2 : 0;
    return a.length === b.length ? Math.min(99, 10 * Math.log10(255 * 255 / (sum / (0.75 * a.length)))) : -1;
};
const pixelsOf = canvas => {
    const flat = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).getContext('2d');
    flat.drawImage(canvas, 0, 0);
    return flat.getImageData(0, 0, canvas.width, canvas.height).data;
};
const player = document.querySelector('adcgs-player');
const part = name => document.querySelector('adcgs-player').shadowRoot.querySelector('[part=' + name + ']');
Element.prototype.setPointerCapture = () => undefined; // simulated pointers cannot be captured
/** How the canvas differs from the exact image of a camera, once it has the player's time. */
const compare = async (camera, title = '') => {
    let got = { picture: {} }, data;
    await until(() => {
        const { width, height } = part('canvas'), time = player.currentTime, old = got.picture;
        if (old.width !== width || old.height !== height || old.time !== time)
            ({ md5: old.digest, data } = player.clip.frame(camera, time, { width, height, fit: 'cover' }));
        got = { picture: { ...old, width, height, time }, psnr: psnr(pixelsOf(part('canvas')), data) };
        return got.psnr >= ${LEAST_DB};
    }, 'image ' + title + ' of the player').catch(() => null);
    return got;
};
`;

const run = script => browser.run(HELPERS + script);

function serve() {
    const server = createServer((request, response) => {
        const path = new URL(request.url, 'http://host').pathname, name = path.endsWith('/') ? `${path}index.html` : path;
        try {
            const data = readFileSync(at(`site${name}`));
            response.writeHead(200, { 'content-type': TYPES[extname(name)] ?? 'application/octet-stream' });
            response.end(data);
        } catch (e) {
            response.writeHead(404);
            response.end();
        }
    });
    return new Promise(resolve => server.listen(0, '127.0.0.1', () => resolve(server)));
}

const server = await serve(), site = `http://127.0.0.1:${server.address().port}`;

async function go(path) {
    await browser.go(`${site}/${path}`);
    await run(`await until(() => document.readyState === 'complete', 'page');`);
}

/** The image on the player's canvas is close to an exact image, which equals that of adcgs-dec. */
async function samePlayer(camera, title, ...options) {
    const got = await run(`return compare(${JSON.stringify(camera)}, ${JSON.stringify(title)});`);
    check(got.psnr >= LEAST_DB, `player: ${title}: ${got.psnr} dB`);
    samePicture(got.picture, at('s.adcgs'), `player: ${title}`, ...options);
    return got.psnr;
}

async function plays() {
    await go('player/dist/');
    await run(`await until(() => part('clock').textContent, 'first image');`);
    const psnr = await samePlayer('home', 'the first image');
    await shot('npm-player');
    console.log(`${kind}: player ${psnr.toFixed(1)} dB`);
    same(await run(`return [player.paused, player.ended, player.currentTime, player.duration.toFixed(3), player.cameras.length,
        part('play').getAttribute('aria-label'), part('canvas').getAttribute('aria-label'), part('controls').hidden,
        document.querySelectorAll('#cameras option').length];`),
         [true, false, 0, '0.233', 2, 'Play', 'The scene', false, 3], 'player: state before it plays');
    // It plays once, and again.
    same(await run(`const events = [], times = [];
        for (const name of ['play', 'pause', 'ended'])
            player.addEventListener(name, () => events.push(name));
        player.addEventListener('timeupdate', () => times.push(player.currentTime));
        player.loop = false;
        await player.play();
        const isPlaying = !player.paused;
        await until(() => events.includes('ended'), 'end');
        const last = player.currentTime;
        player.loop = true;
        part('play').click();
        await until(() => !player.paused && player.currentTime < last, 'second playback');
        player.pause();
        await until(() => events.length === 5, 'pause');
        return [isPlaying, times.length > 1, times.every((time, i) => !i || time > times[i - 1] || time < last), last.toFixed(3),
                events, part('play').getAttribute('aria-label')];`),
         [true, true, true, '0.233', ['play', 'pause', 'ended', 'play', 'pause'], 'Play'], 'player: plays');
    await run('player.currentTime = 0.1;');
    await samePlayer('home', 'another time');
    await run(`player.setCamera('r_003');`);
    await samePlayer('r_003', 'a stored camera', '--camera', '1');
    await run(`player.camera = '0'; part('time').value = part('time').max; part('time').dispatchEvent(new Event('input'));`);
    await samePlayer('r_000', 'a camera and a time by their attributes', '--camera', '0');
    same(await run('return player.currentTime.toFixed(3);'), '0.233', 'player: the time bar');
}

async function input() {
    const key = name => `for (const type of ['keydown', 'keyup'])
        part('canvas').dispatchEvent(new KeyboardEvent(type, { key: '${name}', bubbles: true, composed: true }));`;
    const turned = await run(`${key('Home')} ${key('r')}
        const { psnr: before } = await compare('home'), canvas = part('canvas');
        const box = canvas.getBoundingClientRect();
        const pointer = (type, x) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: box.x + x,
            clientY: box.y + 99, button: 0, buttons: 1, bubbles: true }));
        pointer('pointerdown', 50);
        pointer('pointermove', 150);
        pointer('pointerup', 150);
        const { width, height } = canvas, exact = player.clip.frame('home', 0, { width, height, fit: 'cover' }).data;
        await until(() => psnr(pixelsOf(canvas), exact) < before - 10, 'turned image');
        ${key('r')}
        return player.currentTime;`);
    same(turned, 0, 'player: the key home');
    await samePlayer('home', 'the first view after a drag and the key r');
    // Another context in place of a lost one; and a player that moves in its page.
    await run(`part('canvas').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext();
        await until(() => !part('canvas').getContext('webgl2')?.isContextLost(), 'new canvas');`);
    await samePlayer('home', 'after a lost context');
    await run(`player.removeAttribute('camera'); player.remove();
        if (player.clip || !player.paused)
            throw new Error('a removed player keeps its clip');
        document.body.prepend(player);
        await until(() => player.clip?.isPlayable && part('poster').hidden, 'image of the player in another place');`);
    await samePlayer('home', 'the player in another place');
}

async function exact() {
    same(await run(`const real = HTMLCanvasElement.prototype.getContext;
        const clip = player.clip, flat = Object.assign(document.createElement('canvas'), { width: 80, height: 60 });
        flat.getContext('2d');
        clip.render(flat, 1, 0.1);
        const drawn = psnr(pixelsOf(flat), clip.frame(1, 0.1, { width: 80, height: 60 }).data);
        const off = new OffscreenCanvas(80, 60);
        clip.render(off, { position: [0, 6, 1], target: [0, 0, 0] }, 0.1);
        const other = psnr(pixelsOf(off), clip.frame({ position: [0, 6, 1], target: [0, 0, 0] }, 0.1, off).data) >= ${LEAST_DB};
        // Without WebGL2.
        HTMLCanvasElement.prototype.getContext = function (name, ...rest) {
            return name === 'webgl2' ? null : real.call(this, name, ...rest);
        };
        const plain = document.createElement('adcgs-player');
        Object.assign(plain.style, { width: '90px', height: '60px' });
        plain.setAttribute('time', 0.1);
        plain.src = 'scene.adcgs';
        document.body.append(plain);
        const canvas = await until(() => {
            const found = plain.shadowRoot.querySelector('canvas');
            return plain.clip?.isPlayable && found.width === 90 && plain.shadowRoot.querySelector('output').textContent && found;
        }, 'image without WebGL2');
        const { width, height } = canvas;
        const { data } = plain.clip.frame('home', plain.currentTime, { width, height, fit: 'cover' });
        await until(() => psnr(pixelsOf(canvas), data) === 99, 'exact image without WebGL2');
        plain.remove();
        HTMLCanvasElement.prototype.getContext = real;
        return [drawn, other];`), [99, true], 'images on other canvases');
}

/** Without a bundler: the element, the choice of the module, a worker. */
async function plain() {
    await go('plain/');
    await run(`await until(() => part('clock').textContent, 'first image');`);
    await samePlayer('home', 'without a bundler');
    const got = await run(`const { open } = await import('./adcgs.js');
        const names = performance.getEntriesByType('resource').map(entry => entry.name.split('/').pop());
        const clips = await Promise.all([open('scene.adcgs'), open('scene.adcgs', { wasm: 'adcgs.wasm' }),
                                         open(await fetch('scene.adcgs'), { wasm: fetch('adcgs.wasm') })]);
        await Promise.all(clips.map(clip => clip.ready));
        const text = \`import { open } from '\${new URL('adcgs.js', location)}';
            const clip = await open('\${new URL('scene.adcgs', location)}');
            await clip.ready;
            const canvas = new OffscreenCanvas(64, 48);
            clip.render(canvas, 0, 0.1);
            postMessage({ bitmap: canvas.transferToImageBitmap(), ...clip.frame(0, 0.1, canvas) });\`;
        const worker = new Worker(URL.createObjectURL(new Blob([text], { type: 'text/javascript' })), { type: 'module' });
        const { bitmap, data, md5 } = await new Promise((resolve, reject) => {
            worker.onmessage = event => resolve(event.data);
            worker.onerror = event => reject(new Error(event.message));
        });
        const flat = new OffscreenCanvas(64, 48).getContext('2d');
        flat.drawImage(bitmap, 0, 0);
        return { names, digests: clips.map(clip => clip.frame(0, 0.1, { width: 64, height: 48 }).md5), md5,
                 psnr: psnr(flat.getImageData(0, 0, 64, 48).data, data) };`);
    same(got.names.find(name => name.endsWith('.wasm')), 'adcgs-relaxed.wasm', 'the module in use');
    for (const digest of got.digests)
        samePicture({ width: 64, height: 48, time: 0.1, digest }, at('s.adcgs'), 'the modules', '--camera', '0', '--fit');
    same(got.md5, got.digests[0], 'the frame in a worker');
    check(got.psnr >= LEAST_DB, `the canvas of a worker: ${got.psnr} dB`);
}

async function failures() {
    for (const page of ['player', 'three'])
        for (const [name, text] of [['zeros.adcgs', /^DATA: .*not an adcgs stream/],
                                    ['none.adcgs', /^IO: .*none\.adcgs: .* 404/]]) {
            await go(`${page}/dist/?src=${name}`);
            const got = await run(`return until(() => document.querySelector('#state').textContent, 'message');`);
            check(text.test(got), `${page}: ${name}: ${got}`);
        }
    await go('player/dist/?src=zeros.adcgs');
    const [message, role, rejected] = await run(`await until(() => player.error, 'error');
        return [part('message').textContent, part('message').hidden ? '' : part('message').getAttribute('role'),
                await player.play().then(() => 'plays', e => e.code)];`);
    check(message.includes('not an adcgs stream'), `player: message "${message}"`);
    same([role, rejected], ['alert', 'DATA'], 'player: a broken stream');
}

/** Renders with three.js from the stored camera 0; moves: script that moves the mesh, by which the camera moves, too. */
const THREE_SHOT = `
await until(() => window.mesh?.clip.complete, 'mesh');
renderer.setAnimationLoop(null);
knot.visible = false;
renderer.setPixelRatio(1);
renderer.setSize(200, 150, false);
const stored = mesh.clip.info.cameras[0];
const place = grown => {
    mesh.updateMatrixWorld();
    const flip = new THREE.Matrix4().makeScale(1, -1, -1), pose = new THREE.Matrix4().set(...stored.camToWorld, 0, 0, 0, 1);
    camera.matrixAutoUpdate = false;
    camera.matrix.copy(mesh.matrixWorld).multiply(pose).multiply(flip).scale(new THREE.Vector3(1, 1, 1).divideScalar(grown));
    camera.matrixWorldNeedsUpdate = true;
    Object.assign(camera, { fov: 2 * Math.atan(stored.height / 2 / stored.fy) * 180 / Math.PI, aspect: 200 / 150,
                            near: grown * stored.near, far: 1e4 });
    camera.updateProjectionMatrix();
};
const shot = () => {
    renderer.render(scene, camera);
    return pixelsOf(renderer.domElement);
};
const exact = time => mesh.clip.frame(0, time, { width: 200, height: 150 });
`;

async function three() {
    await go('three/dist/');
    const result = await run(`await until(() => window.mesh && mesh.time > mesh.clip.info.timeStart, 'advancing time');
        ${THREE_SHOT}
        place(1);
        const results = [];
        for (const time of [0, 0.2]) {
            mesh.time = time;
            results.push(psnr(shot(), exact(time).data));
        }
        // The other end of the scene, whose order is the opposite one, then the first again.
        camera.matrix.setPosition(new THREE.Vector3().setFromMatrixPosition(camera.matrix).negate());
        camera.matrix.multiply(new THREE.Matrix4().makeRotationY(Math.PI));
        camera.matrixWorldNeedsUpdate = true;
        const other = psnr(shot(), exact(0.2).data);
        mesh.position.set(3, -1, 2);
        mesh.rotation.set(0.3, 0.7, -0.2);
        mesh.scale.setScalar(2);
        place(2);
        results.push(psnr(shot(), exact(0.2).data));
        const { width, height, md5: digest } = exact(0.2);
        return { results, other, picture: { width, height, time: 0.2, digest } };`);
    check(result.results.every(db => db >= LEAST_DB), `three.js: ${result.results} dB`);
    check(result.other < 30, `three.js: another view has ${result.other} dB`);
    samePicture(result.picture, at('s.adcgs'), 'three.js', '--camera', '0', '--fit');
    console.log(`${kind}: three.js ${result.results.map(db => db.toFixed(1)).join(', ')} dB`);
    await shot('npm-three');
}

async function occlusion() {
    await go('three/dist/');
    same(await run(`${THREE_SHOT}
        place(1);
        mesh.time = 0;
        const wall = new THREE.Mesh(new THREE.PlaneGeometry(1e4, 1e4), new THREE.MeshBasicMaterial({ color: 0xff0000 }));
        wall.matrixAutoUpdate = false;
        scene.add(wall);
        const middle = z => {
            wall.matrix.copy(camera.matrix).multiply(new THREE.Matrix4().makeTranslation(0, 0, -z));
            const at = 4 * (75 * 200 + 100), pixels = shot();
            return [...pixels.subarray(at, at + 3)].join();
        };
        const near = middle(2 * camera.near), far = middle(5e3);
        scene.remove(wall);
        // A mesh without its resources makes new ones. The mesh of a closed clip is empty.
        const before = shot().some((value, i) => i % 4 < 3 && value > 60);
        mesh.dispose();
        const again = shot().some((value, i) => i % 4 < 3 && value > 60);
        mesh.clip.close();
        const closed = shot().some((value, i) => i % 4 < 3 && value > 0);
        return [near, far !== near, before, again, closed];`), ['255,0,0', true, true, true, false], 'three.js: a wall');
}

await runParts([plays, input, exact, plain, failures, three, occlusion]);
server.close();
server.closeAllConnections();
