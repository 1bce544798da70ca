// SPDX-License-Identifier: BSD-2-Clause
// A clip and an object of three.js, in a loop.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { AdcgsMesh } from 'adcgs/three';

const state = document.querySelector('#state'), address = new URLSearchParams(location.search);
const renderer = new THREE.WebGLRenderer();
const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(50, 1, 0.01, 1000);
document.body.append(renderer.domElement);

function resize() {
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(innerWidth, innerHeight);
    camera.aspect = innerWidth / innerHeight;
    camera.updateProjectionMatrix();
}

try {
    const mesh = await AdcgsMesh.load(address.get('src') ?? 'scene.adcgs');
    const { timeStart, duration, scale } = mesh.clip.info;
    const knot = new THREE.Mesh(new THREE.TorusKnotGeometry(0.1 * scale, 0.03 * scale), new THREE.MeshNormalMaterial());
    scene.add(mesh, knot);
    camera.position.set(0, 0.5 * scale, 1.5 * scale);
    const controls = new OrbitControls(camera, renderer.domElement);
    addEventListener('resize', resize);
    resize();
    Object.assign(window, { THREE, renderer, scene, camera, mesh, knot }); // for the console
    renderer.setAnimationLoop(now => {
        mesh.time = timeStart + (duration > 0 ? now / 1000 % duration : 0);
        controls.update();
        renderer.render(scene, camera);
    });
} catch (e) {
    state.textContent = `${e.code ?? e.name}: ${e.message}`;
}
