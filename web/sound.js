// SPDX-License-Identifier: BSD-2-Clause
// The sound of a scene: follows a clock that shows whole frames, to less than 40 ms. Web Audio plays it, since elements of HTML
// seek too coarsely. Nothing here knows the page.
'use strict';

/** The continuous time of a clock that shows whole frames. Each look at a frame bounds it, and the bounds soon lie close together. */
class FrameClock {
    constructor() {
        this.low = -Infinity;   // bounds of the difference between the clock's time and the wall clock, seconds
        this.high = Infinity;
    }

    /** At the wall clock now, the clock shows the frame of a time, which lasts some seconds. A jump discards earlier looks. */
    look(now, time, lasts) {
        const low = time - now, high = low + lasts;
        if (low > this.high || high < this.low)
            Object.assign(this, { low, high });
        this.low = Math.max(this.low, low);
        this.high = Math.min(this.high, high);
    }

    time(now) {
        return now + (this.low + this.high) / 2;
    }

    /** The largest error of the time, seconds. */
    get error() {
        return (this.high - this.low) / 2;
    }
}

class Sound {
    static ERROR_MOST = 0.02;   // seconds: of the clock's time when the sound starts
    static DRIFT_MOST = 0.03;   // seconds
    static SOON = 0.04;         // seconds until it starts: devices take samples in advance
    static LATE = 3;            // looks with a larger drift before the sound starts again: clocks of browsers are coarse

    /** bytes: of a file that the browser decodes. offset: time of the scene at which the file begins, seconds. */
    constructor(bytes, offset = 0) {
        Object.assign(this, { bytes, offset, muted: true, clock: new FrameClock(), context: null, buffer: null, source: null });
        this.starts = this.late = 0;
    }

    /** Call it in an event of the user: else browsers keep the context suspended. Rejects if the browser cannot decode the file. */
    async unmute() {
        this.muted = false;
        if (!this.context) {
            this.context = new AudioContext();
            this.output = this.context.createGain();
            this.output.connect(this.context.destination);
            this.ready = this.context.decodeAudioData(this.bytes.slice().buffer).then(buffer => { this.buffer = buffer; });
        }
        this.context.resume();
        return this.ready;
    }

    mute() {
        this.muted = true;
        this.stop();
    }

    /**
     * Follow the scene: at each image while it plays, and once when it pauses. now: wall clock, seconds; time: of the frame that is
     * shown; lasts: seconds of a frame; plays: whether it plays at its own speed.
     */
    follow(now, time, lasts, plays) {
        const { clock } = this;
        clock.look(now, time, lasts);
        if (!plays || this.muted || !this.buffer || this.context.state !== 'running') {
            this.stop();
            if (!plays)
                this.clock = new FrameClock();
            return;
        }
        const drift = this.source ? Math.abs(this.heard - clock.time(now)) : Infinity;
        this.late = drift > Sound.DRIFT_MOST ? this.late + 1 : 0;
        if (this.source ? this.late >= Sound.LATE || drift > 5 * Sound.DRIFT_MOST : clock.error <= Sound.ERROR_MOST)
            this.start(clock.time(now));
    }

    /** Seconds from the context's clock to the ear. */
    get latency() {
        return this.context.outputLatency || this.context.baseLatency || 0;
    }

    /** Time of the scene that is heard now, or would be, if the sound had started before. */
    get heard() {
        return this.from + this.context.currentTime - this.at - this.latency;
    }

    /** Time of the scene that is heard now; null if it is silent. */
    get time() {
        return this.source && this.context.currentTime >= this.at ? this.heard : null;
    }

    start(time) {
        this.stop();
        this.at = this.context.currentTime + Sound.SOON;
        this.from = time + Sound.SOON + this.latency;
        this.source = new AudioBufferSourceNode(this.context, { buffer: this.buffer });
        this.source.connect(this.output);
        const into = this.from - this.offset;
        this.source.start(this.at + Math.max(0, -into), Math.max(0, into));
        this.late = 0;
        this.starts++;
    }

    stop() {
        if (!this.source)
            return;
        this.source.stop();
        this.source.disconnect();
        this.source = null;
    }

    close() {
        this.stop();
        if (this.context)
            this.context.close();
    }
}
