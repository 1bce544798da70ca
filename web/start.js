// SPDX-License-Identifier: BSD-2-Clause
// Starts the page: the modules, the worker, the GPU, then the scene in the page or the one of the address.
'use strict';

const parameters = new URLSearchParams(location.search);

/** The settings that adcgs-share wrote into the page. */
function readSettings() {
    const settings = $('settings');
    return settings ? JSON.parse(settings.textContent) : {};
}

/** The poster, the title and the sound belong to the scene in the page. */
function removeCard() {
    removeSound();
    for (const id of ['poster', 'backdrop', 'card'])
        if ($(id))
            $(id).remove();
}

async function load() {
    const modules = await unpackModules();
    const which = chooseModule(modules, null);
    if (!which)
        throw new Error('This browser has no WebAssembly with SIMD. A newer one shows the scene.');
    if (which === 'exact')
        note('no relaxed SIMD: the exact module renders, about five times slower');
    view = await Engine.create(modules[which]);
    worker = new Worker(URL.createObjectURL(new Blob([$('worker-text').textContent], { type: 'text/javascript' })));
    worker.onmessage = event => onReply(event.data);
    worker.onerror = event => fail(`worker: ${event.message}`);
    if (parameters.get('module') === 'exact')
        delete modules.relaxed;
    worker.postMessage({ kind: 'modules', modules, threads: Number(parameters.get('threads')) });
    page.gpuChosen = startGpu(parameters.get('draw') === 'exact' ? 'none' : parameters.get('gpu'));
}

/** ?poster: nothing starts before the user, or the script of another page, wants to play. */
function permission() {
    if (!parameters.has('poster'))
        return Promise.resolve();
    setState('waiting');
    $('begin').hidden = false;
    return new Promise(begin => {
        page.begin = () => {
            $('begin').hidden = true;
            begin();
        };
        $('begin').addEventListener('click', page.begin);
    });
}

function openFile(file) {
    if (!file)
        return;
    removeCard();
    document.title = file.name.replace(/\.adcgs$/, '');
    openScene(async () => ({ name: file.name, stream: file.stream(), total: file.size }), wishesOf({}, parameters, false));
}

async function start() {
    const settings = readSettings(), source = parameters.get('src'), inside = $('scene') !== null;
    document.documentElement.classList.toggle('noui', parameters.has('noui') && parameters.get('noui') !== '0');
    if (source)
        removeCard();
    if (source || inside) {
        await permission();
        if (parameters.has('poster') && !parameters.has('autoplay'))
            parameters.set('autoplay', '1');
        showProgress(0, 0);
    }
    if (inside && !source)
        openSound();
    await load();
    listen();
    listenToMute();
    listenToHeadset();
    listenToStick();
    if (source)
        openScene(() => sceneAt(source), wishesOf({}, parameters, true));
    else if (inside)
        openScene(async () => embeddedScene(), wishesOf(settings, parameters, true));
    else
        $('empty').hidden = false;
    if (parameters.has('md5'))
        listDigests(Number(parameters.get('md5')) || 1);
}

window.addEventListener('DOMContentLoaded', () => {
    page.started = performance.now();
    start().catch(e => fail(e.message));
});
