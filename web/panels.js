// SPDX-License-Identifier: BSD-2-Clause
// Elements over the image that are no controls: messages, progress, failures, the hint, help, information, statistics.
'use strict';

// ---- Messages. ----

function say(text) {
    page.message = text;
    $('message').textContent = text;
    if (text)
        $('hint').hidden = true;
}

/** A message of the player stays for three seconds. */
let lastSaid = '', messageTimer = 0;
function showMessage() {
    const text = view.text(view.call.view_message());
    if (text === lastSaid)
        return;
    lastSaid = text;
    if (!text)
        return;
    say(text);
    clearTimeout(messageTimer);
    messageTimer = setTimeout(() => {
        lastSaid = '';
        if (page.message === text)
            say('');
    }, 3000);
}

/** A failure has a place of its own, and a way on. */
function showFailure(text) {
    $('failure').hidden = !text;
    $('why').textContent = text;
    $('again').hidden = !lastSource;
    $('failure').querySelector('.open').hidden = !worker;
}

function fail(text) {
    setState('failed');
    say('');
    page.message = text;
    hideProgress();
    $('begin').hidden = $('empty').hidden = true;
    showFailure(text);
    emit('error', { message: text });
}

// ---- Progress. ----

function sizeText(bytes) {
    return bytes >= 1e6 ? `${(bytes / 1e6).toFixed(1)} MB` : `${Math.ceil(bytes / 1e3)} kB`;
}

/** total: 0 if it is unknown. */
function showProgress(bytes, total) {
    const box = $('progress');
    box.hidden = page.state === 'failed' || page.state === 'complete';
    box.querySelector('i').style.width = `${total ? 100 * Math.min(1, bytes / total) : 4}%`;
    box.querySelector('span').textContent = !bytes ? '' : total ? `${sizeText(bytes)} of ${sizeText(total)}` : sizeText(bytes);
    if (total) {
        box.setAttribute('aria-valuemax', total);
        box.setAttribute('aria-valuenow', bytes);
    }
}

function hideProgress() {
    $('progress').hidden = true;
}

// ---- The device's inputs. ----

function hasTouch() {
    return matchMedia('(any-pointer: coarse)').matches || navigator.maxTouchPoints > 0;
}

/** As in page.css. */
function hasStick() {
    return matchMedia('(pointer: coarse)').matches;
}

function hasMouse() {
    return matchMedia('(any-pointer: fine)').matches || !hasTouch();
}

let hinted = false;
function showHint() {
    if (hinted || page.message)
        return;
    hinted = true;
    $('hint').lastChild.textContent = hasMouse() ? 'Drag to look around, scroll to zoom' : 'Drag to look around, pinch to zoom';
    $('hint').hidden = false;
    setTimeout(hideHint, 6000);
}

const EDGE = 0.4;               // of the way from the edge of the filmed region to the limit
let toldEdge = false;

/** The image gets darker where nothing was filmed: a text explains it once, when the user moves there. */
function explainEdge(outside) {
    if (toldEdge || outside < EDGE || performance.now() - active > 1000)
        return;
    toldEdge = true;
    say(hasMouse() ? 'Not filmed from here: the image is a guess (x: no limit)' : 'Not filmed from here: the image is a guess');
    setTimeout(() => { if (page.message.startsWith('Not filmed')) say(''); }, 4000);
}

function hideHint() {
    $('hint').hidden = true;
}

// ---- Panels. ----

function closeButton(id) {
    const button = element('button', undefined, 'close');
    button.setAttribute('aria-label', 'close');
    button.append(icon('i-close'));
    button.addEventListener('click', () => closePanel(id));
    return button;
}

function icon(name) {
    const made = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    const use = made.appendChild(document.createElementNS('http://www.w3.org/2000/svg', 'use'));
    use.setAttribute('href', `#${name}`);
    return made;
}

const OPENERS = { help: 'keys', facts: 'more' };

/** Shows or hides a panel. The focus goes to it, and back to the button that opens it. */
function showPanel(id, open) {
    const panel = $(id), opener = $(OPENERS[id]);
    if (panel.hidden === !open)
        return;
    const inside = panel.contains(document.activeElement);
    panel.hidden = !open;
    opener.setAttribute('aria-expanded', open);
    if (open)
        panel.focus({ preventScroll: true });
    else if (inside)
        opener.focus({ preventScroll: true });
}

function closePanel(id) {
    if (id === 'help' && view.call.view_help())
        press('h'.charCodeAt(0));
    showPanel(id, false);
}

/** Close the open panel. Returns whether there was one. */
function closePanels() {
    const open = Object.keys(OPENERS).filter(id => !$(id).hidden);
    open.forEach(closePanel);
    return open.length > 0;
}

function toggleFacts() {
    const open = $('facts').hidden;
    closePanels();
    showPanel('facts', open);
}

function keyCells(keys) {
    const cell = element('th');
    for (const key of keys.split(' '))
        cell.append(key === '..' ? '– ' : element('kbd', key));
    return cell;
}

function helpRows(title, rows) {
    const table = element('table');
    for (const [name, text] of rows) {
        const row = table.appendChild(element('tr'));
        row.append(name instanceof Node ? name : element('th', name), element('td', text));
    }
    return [element('h3', title), table];
}

/** The help lists only the inputs of this device. */
function makeHelp() {
    const lines = view.text(view.call.view_help_lines()).trim().split('\n').map(line => line.split('\t'));
    const mouse = lines.filter(([keys]) => /drag|clicks|wheel/.test(keys)), keys = lines.filter(([name]) => !/drag|clicks|wheel/.test(name));
    if (sound)
        keys.push(['m', 'sound']);
    const texts = { p: 'save an image', 'h F1': 'this help' };
    const parts = [element('h2', 'Help')];
    if (hasTouch())
        parts.push(...helpRows('Touch', [['one finger', 'look around'], ['two fingers', 'move and zoom'], ['two taps', 'orbit around this'],
                                         ...hasStick() ? [['stick', 'fly, and one finger turns; a tap on it ends that']] : []]));
    if (hasMouse())
        parts.push(...helpRows('Mouse', mouse),
                   ...helpRows('Keys', keys.map(([name, text]) => [keyCells(name), texts[name] || text])));
    else
        parts.push(...helpRows('Buttons', ['mute', 'loop', 'reset', 'shot', 'more', 'vr', 'full'].filter(id => !$(id).hidden).map(id => {
            const cell = element('th');
            cell.append(icon(id === 'mute' ? 'i-sound' : `i-${id}`));
            return [cell, $(id).getAttribute('aria-label')];
        })));
    $('help').replaceChildren(closeButton('help'), ...parts);
    $('facts').prepend(closeButton('facts'));
}

function statisticsText() {
    const call = view.call, drawn = page.drawn, fast = page.fast;
    const ms = value => (value || 0).toFixed(1);
    const threads = drawn ? drawn.threads : 1;
    return [`module  ${page.module}, ${threads} thread${threads > 1 ? 's' : ''}`,
            `exact   ${drawn ? `${ms(drawn.ms)} ms, ${drawn.width}x${drawn.height}` : '-'}`,
            gpu ? `${page.gpuKind.padEnd(6)}  pack ${ms(fast.packMs)}, ${gpu.sorts ? 'sort and draw' : `sort ${ms(fast.sortMs)}, draw`} ` +
                `${ms(fast.tookMs)} ms, size 1/${page.divider}` : 'gpu     none',
            `splats  ${fast.n || page.facts.gaussians}`,
            `layers  ${call.view_layers()}`,
            `time    ${call.view_time().toFixed(3)} s, frame ${call.view_frame()} of ${call.view_frames()}`,
            `speed   ${call.view_factor()}x${call.view_loop() ? ', loop' : ''}${call.view_flying() ? ', flying' : ''}`,
            `bytes   ${information.received}${page.total ? ` of ${page.total}` : ''}`,
            `first   ${page.first.toFixed(0)} ms`].join('\n');
}
