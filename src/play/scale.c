/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Resolution and detail that follow the time a frame may take. */
#include "config.h"

#include "play/scale.h"

#include "base/base.h"

#define SLOW_PICTURES 2
#define FAST_PICTURES 12
#define TIERS_BEHIND 2 /* the divider from which on tiers are left out first */
#define ROOM 0.75      /* part of the budget that the finer picture is expected to take at most */
#define TIER_TIMES 2.0 /* as long as a picture without a tier that with it is expected to take */

void adcgs_play_scale_init(adcgs_play_scale *scale, int tiers)
{
    *scale = (adcgs_play_scale){.divider = 1, .tiers = tiers, .all = tiers};
}

int adcgs_play_scale_coarser(adcgs_play_scale *scale)
{
    const int possible = scale->divider < ADCGS_PLAY_DIVIDER_MAX, fewer = scale->divider >= TIERS_BEHIND && scale->tiers > 1;
    scale->tiers -= fewer;
    scale->divider += possible && !fewer;
    scale->slow = scale->fast = 0;
    return possible || fewer;
}

/** Whether the tier left out last comes back before pixels do. */
static int tier_is_next(const adcgs_play_scale *scale)
{
    return scale->tiers < scale->all && scale->divider <= TIERS_BEHIND;
}

/** What a picture takes one step finer, if it all went by pixels, or by splats. */
static double finer_seconds(const adcgs_play_scale *scale, double seconds)
{
    const double ratio = (double)scale->divider / (scale->divider - 1);
    return tier_is_next(scale) ? seconds * TIER_TIMES : seconds * ratio * ratio;
}

void adcgs_play_scale_took(adcgs_play_scale *scale, double seconds, double budget)
{
    const int coarse = scale->divider > 1 || scale->tiers < scale->all;
    const int fits = coarse && finer_seconds(scale, seconds) <= ROOM * budget;
    scale->slow = seconds > budget ? scale->slow + 1 : 0;
    scale->fast = fits ? scale->fast + 1 : 0;
    if (scale->slow >= SLOW_PICTURES)
        adcgs_play_scale_coarser(scale);
    else if (scale->fast >= FAST_PICTURES) {
        const int tier = tier_is_next(scale);
        scale->tiers += tier;
        scale->divider -= !tier;
        scale->fast = 0;
    }
}
