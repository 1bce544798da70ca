/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where playing is. Positions follow a clock on the wall, so that frames are
 * left out when they take too long and time never slows down; what is shown is
 * always one of the stream's frames, at the very moment adcgs-dec gives it.
 */
#ifndef ADCGS_PLAY_CLOCK_H
#define ADCGS_PLAY_CLOCK_H

#define ADCGS_PLAY_SPEED_MAX 3 /**< 8 times as fast; 1/8 with a minus */

typedef struct adcgs_play_clock {
    double begin;    /**< moment of the first frame, seconds */
    double rate;     /**< frames in a second */
    int frames;      /**< at least 1 */
    double position; /**< seconds since begin, in [0, frames / rate) */
    double seen;     /**< the clock on the wall at the last tick */
    double reach;    /**< seconds since begin that there is something to play of; behind them playing waits. Infinity: of all */
    int speed;       /**< power of two */
    int playing, loop;
} adcgs_play_clock;

/** The frames from begin to end, both included; not playing, at the first. At most 10^9 frames. */
void adcgs_play_clock_init(adcgs_play_clock *clock, double begin, double end, double rate, double now);
/** Other moments to play, of a stream that turned out to have them; the frame stays, if there is one of its number. */
void adcgs_play_clock_span(adcgs_play_clock *clock, double begin, double end);
/** Go with the clock on the wall, in seconds. Without loop, playing ends at the last frame. */
void adcgs_play_clock_tick(adcgs_play_clock *clock, double now);
/** Play or pause; from the end it plays from the beginning again. One frame alone never plays. */
void adcgs_play_clock_toggle(adcgs_play_clock *clock);
/** Pause some frames further on; around the end with loop. */
void adcgs_play_clock_step(adcgs_play_clock *clock, int frames);
/** The frame at a part of the whole, 0 to 1; goes on playing if it did. */
void adcgs_play_clock_seek(adcgs_play_clock *clock, double part);
/** Double the speed some times, or halve it. */
void adcgs_play_clock_faster(adcgs_play_clock *clock, int steps);

/** Whether it plays, but waits for something to play. */
int adcgs_play_clock_waits(const adcgs_play_clock *clock);
/** Number of the frame to show, from 0. */
int adcgs_play_clock_frame(const adcgs_play_clock *clock);
/** Its moment in seconds. */
double adcgs_play_clock_time(const adcgs_play_clock *clock);
/** How fast it runs: 1/8 to 8. */
double adcgs_play_clock_factor(const adcgs_play_clock *clock);
/** Frames left out when `next` was shown after `last`; with loop it may be the smaller one. */
int adcgs_play_clock_dropped(const adcgs_play_clock *clock, int last, int next);

#endif
