// SPDX-License-Identifier: BSD-2-Clause
// Contents of the file, as a table and a chart of its bytes. Texts in the file are untrusted: always text, never markup.
'use strict';

function element(name, text, className) {
    const made = document.createElement(name);
    if (text !== undefined)
        made.textContent = text;
    if (className)
        made.className = className;
    return made;
}

function rowOf(table, name, ...cells) {
    const row = table.appendChild(element('tr'));
    row.append(element('th', name), ...cells.map(cell => cell instanceof Node ? cell : element('td', cell)));
}

function grouped(n) {
    return Number(n).toLocaleString('en');
}

/** A bar for each part of the file, proportional to its share. */
function bytesChart(bytes) {
    const table = element('table'), largest = Math.max(1, ...Object.keys(bytes).filter(k => k !== 'total').map(k => bytes[k]));
    for (const [name, value] of Object.entries(bytes)) {
        if (name === 'total' || !value)
            continue;
        const bar = element('div', undefined, 'part'), cell = element('td');
        bar.style.width = `${100 * value / largest}%`;
        cell.style.width = '45%';
        cell.append(bar);
        rowOf(table, name, element('td', grouped(value), 'number'), cell);
    }
    rowOf(table, 'total', element('td', grouped(bytes.total), 'number'), '');
    return table;
}

function seconds3(value) {
    return value === null ? '…' : Number(value.toFixed(3));
}

/** For everyone: the length and the size. */
function makeSummary(name, facts) {
    const table = element('table');
    rowOf(table, 'Scene', name);
    if (facts.time_end > facts.time_start)
        rowOf(table, 'Length', `${seconds3(facts.time_end - facts.time_start)} s, ${seconds3(facts.frame_rate)} frames/s`);
    rowOf(table, 'Size', `${grouped(facts.bytes.total)} bytes`);
    rowOf(table, 'Splats', grouped(facts.gaussians));
    return table;
}

/** For engineers. */
function makeDetails(facts) {
    const table = element('table');
    const tiers = facts.tiers > 1 ? `, ${facts.tiers_present} of ${facts.tiers} tiers` : '';
    rowOf(table, 'stream', `${facts.version}, level ${facts.level}`);
    rowOf(table, 'time', `${seconds3(facts.time_start)} to ${seconds3(facts.time_end)} s`);
    const promised = facts.segments_total > facts.segments ? ` of ${facts.segments_total}` : '';
    rowOf(table, 'segments', `${facts.segments}${promised}`);
    rowOf(table, 'anchors', `${grouped(facts.anchors)} (${grouped(facts.static_anchors)} static)`);
    rowOf(table, 'weights', grouped(facts.weights));
    rowOf(table, 'layers', `${facts.layers}${tiers}`);
    rowOf(table, 'cameras', String(facts.cameras));
    rowOf(table, 'colour', facts.colour);
    rowOf(table, 'axes', facts.axes);
    return table;
}

/** notes: missing features of this browser, and faults of the file. page: its name and module. */
function showFacts(summary, details, { name, module }, facts, notes) {
    const table = makeDetails(facts);
    rowOf(table, 'module', module || '…');
    for (const [key, value] of facts.metadata)
        rowOf(table, key, value);
    summary.replaceChildren(makeSummary(name, facts));
    details.replaceChildren(table, element('h3', 'Bytes'), bytesChart(facts.bytes));
    if (notes.length)
        details.append(element('h3', 'Notes'), ...notes.map(note => element('div', note)));
}
