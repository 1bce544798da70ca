// SPDX-License-Identifier: BSD-2-Clause
// A stick on the screen of phones: one thumb flies, the other one turns the view. A tap on it returns to orbiting.
'use strict';

/** Reports the direction of a stick, an element with a knob in it: x to the right and y down, -1 to 1; and taps. */
class Stick {
    static TAP = 0.15;          // of the radius: a touch that moves less is a tap

    constructor(element, { move, tap }) {
        Object.assign(this, { element, knob: element.firstElementChild, move, tap, pointer: null, farthest: 0 });
        for (const [type, act] of [['pointerdown', this.down], ['pointermove', this.drag], ['pointerup', this.up],
                                   ['pointercancel', this.up], ['lostpointercapture', this.up]])
            element.addEventListener(type, event => {
                event.stopPropagation(); // the stage would take it for a drag of the image
                act.call(this, event);
            });
    }

    down(event) {
        if (this.pointer !== null)
            return;
        event.preventDefault();
        this.pointer = event.pointerId;
        this.farthest = 0;
        this.element.setPointerCapture(event.pointerId);
        this.drag(event);
    }

    drag(event) {
        if (event.pointerId !== this.pointer)
            return;
        const box = this.element.getBoundingClientRect(), radius = box.width / 2;
        const x = (event.clientX - box.left) / radius - 1, y = (event.clientY - box.top) / radius - 1;
        this.show(x / Math.max(1, Math.hypot(x, y)), y / Math.max(1, Math.hypot(x, y)));
    }

    up(event) {
        if (event.pointerId !== this.pointer)
            return;
        this.pointer = null;
        this.show(0, 0);
        if (event.type === 'pointerup' && this.farthest < Stick.TAP)
            this.tap();
    }

    show(x, y) {
        this.farthest = Math.max(this.farthest, Math.hypot(x, y));
        this.knob.style.translate = `${50 * x}% ${50 * y}%`;
        this.move(x, y);
    }
}

const STICK_ASIDE = 0.38;       // of the way: with less the stick is in the middle, or along the other axis

function setFlying(flying) {
    if (!opened() || Boolean(view.call.view_flying()) === flying)
        return;
    press('f'.charCodeAt(0));
    lastSaid = view.text(view.call.view_message()); // it names keys
}

/** The stick holds the keys of flight. */
function listenToStick() {
    const held = new Set();
    const hold = (name, down) => {
        if (held.has(name) === down)
            return;
        held[down ? 'add' : 'delete'](name);
        send(KEY, { key: name.charCodeAt(0), down });
    };
    const move = (x, y) => {
        active = performance.now();
        if (Math.hypot(x, y) > STICK_ASIDE)
            setFlying(true);
        for (const [name, way] of [['w', -y], ['s', y], ['a', -x], ['d', x]])
            hold(name, way > STICK_ASIDE);
    };
    new Stick($('stick'), { move, tap: () => setFlying(false) });
}
