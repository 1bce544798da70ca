/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The playback position. It follows the wall clock, so that frames are skipped if they take too long and time never slows down.
 * The shown frame is always one of the stream's frames, at exactly the time that adcgs-dec gives it.
 */
#ifndef ADCGS_PLAY_PLAY_CLOCK_H
#define ADCGS_PLAY_PLAY_CLOCK_H

#define ADCGS_PLAY_SPEED_MAX 3 /**< exponent of 2: 8 times as fast; with a minus 1/8; chosen by hand, not measured */

typedef struct adcgs_play_clock {
    double begin;     /**< time of the first frame, seconds */
    double rate;      /**< frames per second */
    int frames;       /**< at least 1 */
    double position;  /**< seconds since begin, in [0, frames / rate) */
    double seen;      /**< wall clock at the last tick */
    double available; /**< seconds since begin that are available; playback waits there. Infinity: the whole stream */
    int speed;        /**< power of two */
    int playing, loop;
    int turns; /**< how often playback came back from the end since the user chose a frame */
} adcgs_play_clock;

/** Sets the frames from begin to end, both included, at most 10^9. Starts paused, at the first frame. */
void adcgs_play_clock_init(adcgs_play_clock *clock, double begin, double end, double rate, double now);
/** Sets another time range, if the stream turns out to have one. The frame stays, if one with its number exists. */
void adcgs_play_clock_span(adcgs_play_clock *clock, double begin, double end);
/** Follows the wall clock, in seconds. Without loop, playback ends at the last frame. */
void adcgs_play_clock_tick(adcgs_play_clock *clock, double now);
/** Plays or pauses. At the end it plays from the beginning again. A single frame never plays. */
void adcgs_play_clock_toggle(adcgs_play_clock *clock);
/** Pauses some frames later; with loop the end wraps around. */
void adcgs_play_clock_step(adcgs_play_clock *clock, int frames);
/** Goes to the frame at a part of the whole, 0 to 1, and continues playing if it did. */
void adcgs_play_clock_seek(adcgs_play_clock *clock, double part);
/** Doubles the speed several times, or halves it. */
void adcgs_play_clock_faster(adcgs_play_clock *clock, int steps);

/** True if it plays, but waits for data. */
int adcgs_play_clock_waits(const adcgs_play_clock *clock);
/** Number of the frame to show, from 0. */
int adcgs_play_clock_frame(const adcgs_play_clock *clock);
/** The frame's time in seconds. */
double adcgs_play_clock_time(const adcgs_play_clock *clock);
/** Playback speed: 1/8 to 8. */
double adcgs_play_clock_factor(const adcgs_play_clock *clock);
/** Number of frames skipped if `next` was shown after `last`; with loop, next may be smaller. */
int adcgs_play_clock_dropped(const adcgs_play_clock *clock, int last, int next);

#endif
