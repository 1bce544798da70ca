// SPDX-License-Identifier: BSD-2-Clause
// A headset, by WebXR: places the viewer in the scene, renders an image for each eye, and walks by the controllers' sticks. Nothing
// here knows the page.
'use strict';

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
const normal = a => a.map(x => x / (Math.hypot(...a) || 1));
const outer = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const columnOf = (matrix, i) => [...matrix.slice(4 * i, 4 * i + 3)];
/** Turns a vector about the headset's y axis, which points up. */
const turned = ([x, y, z], angle) =>
    [Math.cos(angle) * x + Math.sin(angle) * z, y, Math.cos(angle) * z - Math.sin(angle) * x];

/** The headset's space, in metres with y up, in a scene. It begins at a camera, upright, and moves as the viewer walks. */
class Place {
    static DISTANCE = 2;        // metres from the camera to the middle of a scene whose unit is unknown
    static NEAR = 0.05;         // metres: nothing closer is rendered
    static MARGIN = 0.15;       // part of the image: bound of the Jacobian, as in the specification

    /** stream: its origin, scale, axes and units. camera: its centre and directions in the world. */
    constructor(stream, { right, down, forward, centre }) {
        const ups = { y: [0, 1, 0], z: [0, 0, 1] }, [, axis, sense] = /([yz]) (up|down)/.exec(stream.axes) || [];
        const away = plus(stream.origin, centre, -1), distance = Math.hypot(...away);
        this.up = !axis ? down.map(x => -x) : sense === 'up' ? ups[axis] : ups[axis].map(x => -x);
        const level = plus(forward, this.up, -dot(forward, this.up));
        this.right = Math.hypot(...level) > 1e-3 ? normal(outer(level, this.up)) : right;
        this.back = outer(this.right, this.up);
        this.metre = stream.units === 'metre' ? 1 : distance > 1e-6 * stream.scale ? distance / Place.DISTANCE : stream.scale;
        Object.assign(this, { stream, centre, walked: [0, 0, 0], angle: 0 });
    }

    /** A direction of the headset's space in the scene. */
    direction(v) {
        const [x, y, z] = turned(v, this.angle);
        return [0, 1, 2].map(i => x * this.right[i] + y * this.up[i] + z * this.back[i]);
    }

    /** A point of the headset's space, in units of the scene. */
    point(p) {
        const { origin, scale } = this.stream, at = plus(turned(p, this.angle), this.walked);
        return [0, 1, 2].map(i => (this.centre[i] - origin[i] +
            this.metre * (at[0] * this.right[i] + at[1] * this.up[i] + at[2] * this.back[i])) / scale);
    }

    /** The shader's numbers for an eye: its pose, its projection (columns of 4x4), and the size of its image. */
    uniforms(pose, projection, width, height) {
        const rows = [this.direction(columnOf(pose, 0)), this.direction(columnOf(pose, 1)).map(x => -x),
                      this.direction(columnOf(pose, 2)).map(x => -x)];
        const at = this.point(columnOf(pose, 3));
        const lens = [projection[0] * width / 2, projection[5] * height / 2, (1 - projection[8]) * width / 2,
                      (1 + projection[9]) * height / 2];
        const limits = [0, 1].flatMap(i => [-lens[2 + i] - Place.MARGIN * [width, height][i],
                                            [width, height][i] * (1 + Place.MARGIN) - lens[2 + i]].map(x => x / lens[i]));
        return new Float32Array([...rows.flat(), ...rows.map(row => -dot(row, at)), ...lens,
                                 Place.NEAR * this.metre / this.stream.scale, ...limits]);
    }

    /** Walks on the level, metres to the right and forward as the viewer's head looks. */
    walk(head, right, forward) {
        const ahead = turned([-head[8], 0, -head[10]], this.angle), length = Math.hypot(...ahead) || 1;
        const step = ahead.map(x => x / length);
        this.walked = plus(plus(this.walked, step, forward), [-step[2], 0, step[0]], right);
    }

    /** Turns about the viewer's head. */
    turn(head, angle) {
        const at = columnOf(head, 3), before = plus(turned(at, this.angle), this.walked);
        this.angle += angle;
        this.walked = plus(before, turned(at, this.angle), -1);
    }
}

class Headset {
    static SPEED = 1.5;         // metres per second, with the stick at its end
    static DEAD = 0.15;         // of the stick's way: no movement
    static TURN = Math.PI / 6;  // a turn, as the right stick goes aside

    /**
     * Starts a session; call it in an event of the user. scene: background and filter for the GPU; image(direction) is called once
     * for both eyes, select() for the trigger, end() at the end.
     */
    static async enter(gpu, place, scene) {
        const session = await navigator.xr.requestSession('immersive-vr');
        const headset = Object.assign(new Headset(), { gpu, place, scene, session, last: 0, aside: false });
        session.addEventListener('end', () => scene.end());
        session.addEventListener('select', () => scene.select());
        try {
            await gpu.gl.makeXRCompatible();
            headset.layer = new XRWebGLLayer(session, gpu.gl, { antialias: false, depth: false, alpha: false });
            await session.updateRenderState({ baseLayer: headset.layer });
            headset.space = await session.requestReferenceSpace('local');
        } catch (e) {
            session.end();
            throw e;
        }
        session.requestAnimationFrame((time, frame) => headset.image(time, frame));
        return headset;
    }

    end() {
        return this.session.end();
    }

    image(time, frame) {
        const { gpu, layer, place, scene, session } = this, pose = frame.getViewerPose(this.space);
        session.requestAnimationFrame((next, its) => this.image(next, its));
        if (!pose)
            return;
        const head = pose.transform.matrix;
        this.move(head, Math.min((time - (this.last || time)) / 1000, 0.1));
        this.last = time;
        scene.image(place.direction(columnOf(head, 2)).map(x => -x));
        gpu.begin(layer.framebuffer, layer.framebufferWidth, layer.framebufferHeight, scene.background);
        for (const eye of pose.views) {
            const box = layer.getViewport(eye);
            gpu.paint(place.uniforms(eye.transform.matrix, eye.projectionMatrix, box.width, box.height), box, scene.filter);
        }
    }

    /** The left stick walks; the right one turns, and walks ahead. A single one walks. */
    move(head, seconds) {
        const sticks = [...this.session.inputSources].filter(source => source.gamepad && source.gamepad.axes.length >= 4);
        for (const { handedness, gamepad } of sticks) {
            const [x, y] = [gamepad.axes[2], gamepad.axes[3]].map(a => Math.abs(a) > Headset.DEAD ? a : 0);
            const turns = handedness === 'right' && sticks.length > 1, step = Headset.SPEED * seconds;
            this.place.walk(head, turns ? 0 : step * x, -step * y);
            const aside = turns && Math.abs(x) > 0.7;
            if (aside && !this.aside)
                this.place.turn(head, -Math.sign(x) * Headset.TURN);
            if (turns)
                this.aside = aside;
        }
    }
}
