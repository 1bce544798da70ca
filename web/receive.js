// SPDX-License-Identifier: BSD-2-Clause
// Receives a scene: its bytes on their way to the worker, and the worker's reports about them. A scene opens as the page's
// settings and its address ask.
'use strict';

const CAMERA_NAME = 144;        // position of the name in adcgs_camera
let lastSource = null;          // for another try
let wishes = {};                // of the scene being opened: camera, time, loop, autoplay
let pendingTime = null;         // wished, but not received yet

/** A number of the address, or null. */
function numberOf(parameters, name) {
    const text = parameters.get(name);
    return text !== null && text.trim() !== '' && isFinite(text) ? Number(text) : null;
}

/** Whether to play at once: as the address says, else unless the user prefers less motion. */
function playsAtOnce(parameters) {
    if (parameters.has('md5'))
        return false;
    if (parameters.has('autoplay'))
        return !['0', 'false', 'off', 'no'].includes(parameters.get('autoplay'));
    return !matchMedia('(prefers-reduced-motion: reduce)').matches;
}

/** The wishes for a scene: settings hold for the one in the page, the address for that and for ?src=. */
function wishesOf(settings, parameters, own) {
    const text = own ? parameters.get('camera') : null, time = own ? numberOf(parameters, 't') : null;
    return { camera: text !== null ? text : settings.camera === undefined ? null : settings.camera,
             time: time !== null ? time : settings.time === undefined ? null : settings.time,
             loop: settings.loop !== false, autoplay: playsAtOnce(parameters) };
}

/** wanted: the wishes, see wishesOf(). */
async function openScene(getSource, wanted) {
    const number = ++reading, ours = new Flow(AHEAD);
    flow.end();
    flow = ours;
    lastSource = () => openScene(getSource, wanted);
    wishes = wanted;
    pendingTime = null;
    setState('loading');
    say('');
    showFailure('');
    $('empty').hidden = true;
    information = null;
    shownKey = '';
    Object.assign(page, { name: '', total: 0, facts: null, picture: null, drawn: null, first: 0, opened: performance.now() });
    page.notes = page.notes.filter(text => !text.startsWith('file: '));
    showProgress(0, 0);
    worker.postMessage({ kind: 'open', number });
    try {
        const source = await getSource();
        Object.assign(page, { name: source.name, total: source.total || 0 });
        await readStream(source.stream, ours, bytes => {
            if (number === reading)
                worker.postMessage({ kind: 'bytes', bytes }, [bytes.buffer]);
        });
    } catch (e) {
        if (number === reading)
            note('file: ' + e.message);
    }
    if (number === reading)
        worker.postMessage({ kind: 'end' });
}

// ---- Stored cameras. ----

function storedCamera(index) {
    const at = index * view.call.page_filmed_size(); // the camera comes first in each
    return information.cameras.slice(at, at + view.call.page_camera_size());
}

function storedNames() {
    const names = [];
    for (let i = 0; information && information.home && i < information.facts.cameras; i++) {
        const name = storedCamera(i).subarray(CAMERA_NAME);
        names.push(new TextDecoder().decode(name.subarray(0, name.indexOf(0))));
    }
    return names;
}

/** The index of the stored camera with this name or number; -1 if there is none. */
function storedIndex(wanted) {
    const names = storedNames(), named = names.indexOf(String(wanted));
    const number = String(wanted).trim() === '' ? -1 : Number(wanted);
    return named >= 0 ? named : Number.isInteger(number) && number >= 0 && number < names.length ? number : -1;
}

// ---- Reports of the worker. ----

/** Open the scene in the view as wished. */
function openView({ info, home, cameras, facts }, over) {
    const index = wishes.camera === null ? -1 : storedIndex(wishes.camera), first = index < 0 ? home : storedCamera(index);
    view.with([info, first, cameras], (i, h, c) => view.call.view_open(i, h, c, over));
    view.call.view_tick(performance.now() / 1000);
    view.call.view_start(wishes.time === null ? facts.time_start : wishes.time, wishes.loop ? 1 : 0, wishes.autoplay ? 1 : 0);
    pendingTime = wishes.time;
    if (wishes.camera !== null && index < 0)
        say(`no camera “${wishes.camera}”: the scene stores ${facts.cameras}`);
}

/** Take a report of the worker. The view gets copies of the data that the worker's instance found. */
function takeReport(report) {
    const first = information === null || !information.home;
    information = report;
    page.facts = report.facts || null;
    generation++;
    if (report.home) {
        const over = report.ended ? 1 : 0;
        if (first)
            openView(report, over);
        else
            view.with([report.info], i => view.call.view_span(i, over));
        if (pendingTime !== null && !first)
            seekTo(pendingTime);
        if (report.ended || pendingTime <= report.facts.time_end)
            pendingTime = null;
    }
    if (report.ended)
        finish(report);
    showControls();
    if (page.facts)
        showFacts($('summary'), $('details'), page, page.facts, page.notes);
    wake();
}

function seekTo(seconds) {
    const { time_start: begin, frame_rate: rate } = page.facts;
    view.call.view_tick(performance.now() / 1000);
    view.call.view_seek((seconds - begin) * rate / Math.max(1, view.call.view_frames() - 1));
    wake();
}

function finish(report) {
    if (report.failed)
        note('file: ' + report.failed);
    if (report.fault && report.fault !== report.failed)
        note('file: ' + report.fault);
    hideProgress();
    const wrong = page.notes.filter(text => text.startsWith('file: ')).map(text => text.slice(6));
    if (!report.drawable)
        fail(`${page.name ? `${page.name}: ` : ''}${wrong[0] || 'ends before anything can be rendered'}`);
    else if (report.failed || (report.facts && report.facts.faults))
        say(`${page.name}: damaged; showing the intact parts (${wrong[0]})`);
    else if (report.facts && report.facts.truncated)
        say(`${page.name}: ends early; showing the complete part`);
    if (report.drawable)
        setState('complete');
}
