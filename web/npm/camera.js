// SPDX-License-Identifier: BSD-2-Clause
// Cameras: objects of scripts, and the bytes of adcgs_camera (adcgs/types.h).
import { AdcgsError } from './error.js';
import { poseLookingAt } from './look.js';

const WIDTH = 0, HEIGHT = 4, LENS = 8, POSE = 40, NEAR = 136, NAME = 144, NAME_MOST = 63; // bytes in adcgs_camera
const TIME = 208, PATH = 216;                                                           // in adcgs_filmed_camera
const LENS_MEMBERS = ['fx', 'fy', 'cx', 'cy'];

export function readCamera(bytes) {
    const numbers = new DataView(bytes.buffer, bytes.byteOffset), name = bytes.subarray(NAME);
    const camera = { name: new TextDecoder().decode(name.subarray(0, name.indexOf(0))),
                     width: numbers.getInt32(WIDTH, true), height: numbers.getInt32(HEIGHT, true) };
    LENS_MEMBERS.forEach((member, i) => { camera[member] = numbers.getFloat64(LENS + 8 * i, true); });
    camera.camToWorld = Array.from({ length: 12 }, (_, i) => numbers.getFloat64(POSE + 8 * i, true));
    camera.near = numbers.getFloat64(NEAR, true);
    return camera;
}

/** A stored camera with its time and path. */
export function readFilmed(bytes) {
    const numbers = new DataView(bytes.buffer, bytes.byteOffset), time = numbers.getFloat64(TIME, true);
    const path = numbers.getInt32(PATH, true);
    return { ...readCamera(bytes), time: Number.isNaN(time) ? null : time, path: path < 0 ? null : path };
}

function finite(value, text) {
    if (typeof value !== 'number' || !Number.isFinite(value))
        throw new AdcgsError('USAGE', `camera: ${text} is ${value}, expected a finite number`);
    return value;
}

function vector(value, text) {
    if (typeof value?.length !== 'number' || value.length !== 3)
        throw new AdcgsError('USAGE', `camera: ${text}, expected an array of three numbers`);
    return Array.from(value, x => finite(x, text));
}

export function writeCamera(camera, size) {
    const bytes = new Uint8Array(size), numbers = new DataView(bytes.buffer);
    for (const [member, at] of [['width', WIDTH], ['height', HEIGHT]]) {
        if (!(Number.isInteger(camera[member]) && camera[member] > 0))
            throw new AdcgsError('USAGE', `camera: ${member} is ${camera[member]}, expected a number of pixels`);
        numbers.setInt32(at, camera[member], true);
    }
    LENS_MEMBERS.forEach((member, i) => numbers.setFloat64(LENS + 8 * i, finite(camera[member], member), true));
    if (camera.camToWorld?.length !== 12)
        throw new AdcgsError('USAGE', 'camera: camToWorld, expected 12 numbers, a matrix of 3 rows and 4 columns');
    Array.from(camera.camToWorld, (x, i) => numbers.setFloat64(POSE + 8 * i, finite(x, 'camToWorld'), true));
    numbers.setFloat64(NEAR, finite(camera.near, 'near'), true);
    bytes.set(new TextEncoder().encode(camera.name || '').subarray(0, NAME_MOST), NAME);
    return bytes;
}

/** A camera at a position with a target in the middle of its image; the first view of the clip gives the missing members. */
export function lookAt({ position, target, up, fov, near }, home, centre, width, height) {
    const place = vector(position, 'position'), aim = target ? vector(target, 'target') : centre;
    const upright = up ? vector(up, 'up') : [1, 5, 9].map(i => -home.camToWorld[i]);
    const camToWorld = poseLookingAt(place, aim, upright, why => {
        throw new AdcgsError('USAGE', `camera: ${why}`);
    });
    const angle = fov === undefined ? 2 * Math.atan(home.height / 2 / home.fy) : finite(fov, 'fov') * Math.PI / 180;
    const focal = height / 2 / Math.tan(angle / 2);
    return { width, height, fx: focal, fy: focal, cx: width / 2, cy: height / 2, near: near === undefined ? home.near : near, camToWorld };
}
