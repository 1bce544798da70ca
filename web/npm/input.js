// SPDX-License-Identifier: BSD-2-Clause
// Mouse, fingers and keys of the player turn into events of the view (src/play/event.h).
import { BUTTON, KEY, KEYS, LOST, MOTION, WHEEL, WHEEL_STEP, ZOOM_STEP } from './events.js';

const USED_KEYS = [' ', 'ArrowLeft', 'ArrowRight', 'Home', 'End', ',', '.', '[', ']', 'r'];
const LEFT = 1, RIGHT = 3; // buttons

export class Input {
    /** wake() is called after each event. The functions of the module are in call, once there is a view. */
    constructor(element, wake) {
        this.element = element;
        this.wake = wake;
        this.call = null;
        this.pointers = new Map();
        element.addEventListener('keydown', event => this.onKey(event, true));
        element.addEventListener('keyup', event => this.onKey(event, false));
        element.addEventListener('blur', () => this.send(LOST));
    }

    listen(canvas) {
        this.pointers.clear();
        canvas.addEventListener('pointerdown', event => this.onDown(event, canvas));
        canvas.addEventListener('pointermove', event => this.onMove(event));
        canvas.addEventListener('pointerup', event => this.onUp(event));
        canvas.addEventListener('pointercancel', event => this.onUp(event));
        canvas.addEventListener('contextmenu', event => event.preventDefault());
        canvas.addEventListener('wheel', event => this.onWheel(event, canvas), { passive: false });
    }

    tick() {
        this.call.view_tick(performance.now() / 1000);
    }

    send(kind, { key = 0, down = 0, again = 0, button = 0, x = 0, y = 0, dx = 0, dy = 0 } = {}) {
        if (!this.call)
            return;
        this.tick();
        this.call.view_event(kind, key, down, again, button, x, y, dx, dy);
        this.wake();
    }

    press(key) {
        this.send(KEY, { key: key.charCodeAt(0), down: 1 });
        this.send(KEY, { key: key.charCodeAt(0) });
    }

    onKey(event, down) {
        const isOther = event.ctrlKey || event.metaKey || event.altKey || !USED_KEYS.includes(event.key);
        if (isOther || !this.call || event.composedPath()[0].matches?.('button, input'))
            return;
        const key = KEYS[event.key] || event.key.charCodeAt(0);
        this.send(KEY, { key, down: down ? 1 : 0, again: event.repeat ? 1 : 0 });
        event.preventDefault();
    }

    placeOf(event) {
        const box = this.element.getBoundingClientRect(), dense = window.devicePixelRatio || 1;
        return { x: (event.clientX - box.left) * dense, y: (event.clientY - box.top) * dense };
    }

    onDown(event, canvas) {
        canvas.setPointerCapture(event.pointerId);
        canvas.focus({ preventScroll: true });
        this.pointers.set(event.pointerId, this.placeOf(event));
        const isOne = this.pointers.size === 1;
        this.send(BUTTON, { ...this.placeOf(event), down: isOne ? 1 : 0, button: isOne && event.button === 2 ? RIGHT : LEFT });
    }

    /** Midpoint and distance of two fingers. */
    pinch() {
        const [a, b] = [...this.pointers.values()];
        return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, distance: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) };
    }

    onMove(event) {
        const before = this.pointers.get(event.pointerId), at = this.placeOf(event);
        if (!before || !this.call)
            return;
        const old = this.pointers.size === 2 && this.pinch();
        this.pointers.set(event.pointerId, at);
        if (this.pointers.size === 1)
            this.send(MOTION, { ...at, dx: at.x - before.x, dy: at.y - before.y });
        if (!old)
            return;
        const now = this.pinch();
        this.tick();
        this.call.view_pinch(now.x - old.x, now.y - old.y, Math.log(old.distance / now.distance) / Math.log(ZOOM_STEP));
        this.wake();
    }

    onUp(event) {
        this.pointers.delete(event.pointerId);
        this.send(BUTTON, { ...this.placeOf(event), down: 0, button: event.button === 2 ? RIGHT : LEFT });
    }

    /** The wheel zooms only after a click, since it also scrolls the page around the element. */
    onWheel(event, canvas) {
        if (!this.call || canvas.getRootNode().activeElement !== canvas)
            return;
        event.preventDefault();
        this.send(WHEEL, { dy: -event.deltaY / (event.deltaMode ? 3 : WHEEL_STEP) });
    }
}
