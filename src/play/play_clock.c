/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The playback position. */
#include "config.h"

#include "play/play_clock.h"

#include "base/base.h"

#include <math.h>

/* Origin: chosen by hand, not measured. */
#define FRAMES_MAX 1e9 /* frames of a scene, at most; an int holds them */
#define ROUNDING 1e-6  /* frames: error of a position due to rounded times */

static double length(const adcgs_play_clock *clock)
{
    return clock->frames / clock->rate;
}

void adcgs_play_clock_init(adcgs_play_clock *clock, double begin, double end, double rate, double now)
{
    *clock = (adcgs_play_clock){.rate = rate, .seen = now, .available = INFINITY, .loop = 1};
    adcgs_play_clock_span(clock, begin, end);
}

static void go_to(adcgs_play_clock *clock, int frame)
{
    clock->position = frame / clock->rate;
    clock->turns = 0;
}

void adcgs_play_clock_span(adcgs_play_clock *clock, double begin, double end)
{
    const double frames = floor((end - begin) * clock->rate + ROUNDING) + 1.0;
    clock->begin = begin;
    clock->frames = (int)ADCGS_MAX(1.0, ADCGS_MIN(frames, FRAMES_MAX));
    if (clock->position >= length(clock))
        go_to(clock, clock->frames - 1);
}

void adcgs_play_clock_tick(adcgs_play_clock *clock, double now)
{
    const double passed = ADCGS_MAX(0.0, now - clock->seen);
    clock->seen = now;
    if (!clock->playing || adcgs_play_clock_waits(clock))
        return;
    clock->position = ADCGS_MIN(clock->position + passed * adcgs_play_clock_factor(clock), clock->available);
    if (clock->position < length(clock))
        return;
    clock->playing = clock->loop;
    if (clock->loop) {
        clock->position = fmod(clock->position, length(clock));
        clock->turns++;
    } else
        go_to(clock, clock->frames - 1);
}

void adcgs_play_clock_toggle(adcgs_play_clock *clock)
{
    clock->playing = !clock->playing && clock->frames > 1;
    if (clock->playing && !clock->loop && adcgs_play_clock_frame(clock) == clock->frames - 1)
        go_to(clock, 0);
}

void adcgs_play_clock_step(adcgs_play_clock *clock, int frames)
{
    const double n = clock->frames;
    double frame = (double)adcgs_play_clock_frame(clock) + frames;
    clock->playing = 0;
    if (clock->loop)
        frame -= n * floor(frame / n);
    go_to(clock, (int)ADCGS_MAX(0.0, ADCGS_MIN(frame, n - 1.0)));
}

void adcgs_play_clock_seek(adcgs_play_clock *clock, double part)
{
    go_to(clock, (int)floor(ADCGS_MAX(0.0, ADCGS_MIN(part, 1.0)) * (clock->frames - 1) + 0.5));
}

void adcgs_play_clock_faster(adcgs_play_clock *clock, int steps)
{
    clock->speed = ADCGS_MAX(-ADCGS_PLAY_SPEED_MAX, ADCGS_MIN(clock->speed + steps, ADCGS_PLAY_SPEED_MAX));
}

int adcgs_play_clock_waits(const adcgs_play_clock *clock)
{
    return clock->playing && clock->position >= clock->available;
}

int adcgs_play_clock_frame(const adcgs_play_clock *clock)
{
    return (int)ADCGS_MIN(floor(clock->position * clock->rate + ROUNDING), (double)(clock->frames - 1));
}

double adcgs_play_clock_time(const adcgs_play_clock *clock)
{
    return clock->begin + adcgs_play_clock_frame(clock) / clock->rate;
}

double adcgs_play_clock_factor(const adcgs_play_clock *clock)
{
    return ldexp(1.0, clock->speed);
}

int adcgs_play_clock_dropped(const adcgs_play_clock *clock, int last, int next)
{
    const int further = next >= last ? next - last : clock->loop ? next - last + clock->frames : 0;
    return ADCGS_MAX(0, further - 1);
}
