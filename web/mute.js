// SPDX-License-Identifier: BSD-2-Clause
// The button of the sound. Browsers allow sound after an action of the user, so a page starts muted.
'use strict';

let sound = null;               // of the scene in the page

function showMuted() {
    $('mute').hidden = !sound;
    $('mute').setAttribute('aria-pressed', Boolean(sound && !sound.muted));
}

/** The sound follows the scene, except at other speeds, while bytes are missing, and in a hidden page. */
function followSound() {
    const call = view.call;
    if (sound)
        sound.follow(performance.now() / 1000, call.view_time(), 1 / page.facts.frame_rate,
                     Boolean(call.view_playing() && !call.view_waits() && call.view_factor() === 1 && !document.hidden));
}

function unmute(ours) {
    ours.unmute().then(wake, () => {
        if (sound !== ours)
            return;
        removeSound();
        say('This browser cannot play the sound of this scene');
    });
}

function setMuted(muted) {
    if (!sound)
        return;
    if (muted)
        sound.mute();
    else
        unmute(sound);
    showMuted();
}

/** The sound in the page belongs to its scene. */
function openSound() {
    const text = $('sound');
    if (text && 'AudioContext' in window)
        sound = new Sound(fromBase64(text.textContent), Number(text.dataset.offset));
    showMuted();
}

function removeSound() {
    if (sound)
        sound.close();
    sound = null;
    showMuted();
}

function listenToMute() {
    $('mute').addEventListener('click', () => setMuted(!sound.muted));
    window.addEventListener('keydown', event => {
        if (sound && event.key.toLowerCase() === 'm' && !event.repeat && !event.ctrlKey && !event.metaKey && !event.altKey)
            setMuted(!sound.muted);
    });
    // A page that a script unmuted is heard from the next action of the user on.
    window.addEventListener('pointerdown', () => sound && !sound.muted && unmute(sound));
    document.addEventListener('visibilitychange', () => {
        if (opened())
            followSound();
        wake();
    });
}
