/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Resolution that follows the time a frame may take. */
#include "config.h"

#include "play/scale.h"

#include "base/base.h"

#define SLOW_PICTURES 2
#define FAST_PICTURES 12
#define ROOM 0.75 /* part of the budget that the finer picture is expected to take at most */

void adcgs_play_scale_init(adcgs_play_scale *scale)
{
    *scale = (adcgs_play_scale){.divider = 1};
}

int adcgs_play_scale_coarser(adcgs_play_scale *scale)
{
    const int possible = scale->divider < ADCGS_PLAY_DIVIDER_MAX;
    scale->divider += possible;
    scale->slow = scale->fast = 0;
    return possible;
}

/** What a picture takes at the next finer divider, if it all went by pixels. */
static double finer_seconds(int divider, double seconds)
{
    const double ratio = (double)divider / (divider - 1);
    return seconds * ratio * ratio;
}

void adcgs_play_scale_took(adcgs_play_scale *scale, double seconds, double budget)
{
    const int fits = scale->divider > 1 && finer_seconds(scale->divider, seconds) <= ROOM * budget;
    scale->slow = seconds > budget ? scale->slow + 1 : 0;
    scale->fast = fits ? scale->fast + 1 : 0;
    if (scale->slow >= SLOW_PICTURES)
        adcgs_play_scale_coarser(scale);
    else if (scale->fast >= FAST_PICTURES) {
        scale->divider--;
        scale->fast = 0;
    }
}
