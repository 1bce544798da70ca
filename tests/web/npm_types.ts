// SPDX-License-Identifier: BSD-2-Clause
// All of the npm package's types in use; test_npm.sh checks them with tsc.
import { AdcgsError, open, type Camera, type Clip, type Splats } from 'adcgs';
import { AdcgsPlayer } from 'adcgs/player';
import { AdcgsMesh } from 'adcgs/three';
import { Scene } from 'three';

export async function use(canvas: HTMLCanvasElement, bytes: Uint8Array<ArrayBuffer>): Promise<number> {
    const { signal } = new AbortController();
    const clip: Clip = await open('scene.adcgs', { signal, wasm: fetch('adcgs.wasm') });
    await Promise.all([open(new URL('https://example.org/')), open(bytes), open(bytes.buffer), open(new Blob([bytes])),
                       open(new Response(bytes)), open(new Blob([bytes]).stream())]);
    await clip.playable;
    const splats: Splats = clip.splats(0.5), total: number = clip.info.bytes.total + clip.available + splats.positions[0];
    const cameras: Camera[] = ['home', 'front', 0, clip.info.cameras[0], { position: [0, 1, 2], target: [0, 0, 0], fov: 40 }];
    cameras.forEach(camera => clip.render(canvas, camera, 0));
    const { data, width, height, md5 } = clip.frame('home', 0, { width: 40 });
    canvas.getContext('2d')?.putImageData(new ImageData(data, width, height), md5.length, 0);
    clip.addEventListener('progress', () => clip.close());
    // @ts-expect-error: a time is a number
    clip.splats('now');
    // @ts-expect-error: a position has three numbers
    clip.render(canvas, { position: [0, 1] }, 0);
    // @ts-expect-error: open() makes clips
    new clip.constructor.Clip();

    const player: AdcgsPlayer = document.createElement('adcgs-player');
    Object.assign(player, { src: 'scene.adcgs', loop: true });
    player.addEventListener('timeupdate', () => player.currentTime + player.duration);
    await player.play();
    player.setCamera({ position: [0, 1, 2] });
    const failure: AdcgsError | null = player.error;

    const mesh = await AdcgsMesh.load('scene.adcgs');
    new Scene().add(mesh, new AdcgsMesh(clip));
    mesh.time = 0.5;
    mesh.dispose();
    return total + (failure?.code === 'DATA' ? 1 : 0);
}
