// SPDX-License-Identifier: BSD-2-Clause
import 'adcgs/player';

const player = document.querySelector('adcgs-player'), cameras = document.querySelector('#cameras');
const state = document.querySelector('#state'), address = new URLSearchParams(location.search);

player.addEventListener('canplay', () => {
    cameras.append(...player.cameras.map((name, index) => new Option(name || `camera ${index}`, String(index))));
});
player.addEventListener('timeupdate', () => {
    state.textContent = `${player.currentTime.toFixed(2)} of ${player.duration.toFixed(2)} s`;
});
player.addEventListener('error', () => {
    state.textContent = `${player.error.code}: ${player.error.message}`;
});
cameras.addEventListener('change', () => player.setCamera(cameras.value === 'home' ? 'home' : Number(cameras.value)));

player.src = address.get('src') ?? 'scene.adcgs';
