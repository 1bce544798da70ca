/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Resolution and detail, adapted to the time of a frame. */
#include "config.h"

#include "play/scale.h"

#include "base/base.h"

/* Origin, unless a line states one: chosen by hand, not measured. */
#define SLOW_PICTURES 2  /* images in succession that took too long, after which the scale falls */
#define FAST_PICTURES 12 /* images in succession that would fit at the finer scale, after which it rises */
/*
 * The divider from which on tiers are left out first; calibrated on a clip of 21,000 splats at 1280x800. There a size of 1/4
 * is within 37 dB of the whole image, one tier less only within 25 dB.
 */
#define TIERS_BEHIND 4
/* Budgets: for that reason an image may take longer before tiers are left out: few sharp images, not many blurred. */
#define TIER_BUDGETS 3
#define ROOM 0.75      /* share of the budget that the finer image may take according to the estimate */
#define TIER_TIMES 2.0 /* estimated ratio of the render times with and without a tier */

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

/** The longest render time of the present scale. */
static double longest(const adcgs_play_scale *scale, double budget)
{
    return scale->divider == TIERS_BEHIND && scale->tiers > 1 ? TIER_BUDGETS * budget : budget;
}

/** True if the last dropped tier returns before the resolution rises. */
static int tier_is_next(const adcgs_play_scale *scale)
{
    return scale->tiers < scale->all && scale->divider <= TIERS_BEHIND;
}

/** Estimates the render time one step finer, as if it depended on pixels only, or on splats only. */
static double finer_seconds(const adcgs_play_scale *scale, double seconds)
{
    const double ratio = (double)scale->divider / (scale->divider - 1);
    return tier_is_next(scale) ? seconds * TIER_TIMES : seconds * ratio * ratio;
}

void adcgs_play_scale_took(adcgs_play_scale *scale, double seconds, double budget)
{
    const int coarse = scale->divider > 1 || scale->tiers < scale->all;
    const double room = ROOM * (tier_is_next(scale) ? TIER_BUDGETS : 1) * budget;
    const int fits = coarse && finer_seconds(scale, seconds) <= room;
    scale->slow = seconds > longest(scale, budget) ? scale->slow + 1 : 0;
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
