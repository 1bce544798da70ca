/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Remaining time of a run. */
#include "train/time_left.h"

#include "train/stage_table.h"

#include <math.h>

#define KEEP 0.98 /* decay of the running mean of an iteration's cost; chosen by hand, not measured */
/*
 * Share of an iteration at full resolution that is independent of pixels; until two levels are measured; chosen by hand, not
 * measured.
 */
#define OVERHEAD 0.2

int adcgs_coarse_divide(const adcgs_train_config *c, double progress)
{
    return adcgs_stage_lasts(c, ADCGS_STAGE_QUARTER_SIZE, progress) ? 4
           : adcgs_stage_lasts(c, ADCGS_STAGE_HALF_SIZE, progress)  ? 2
                                                                    : 1;
}

static int level_of(int divide)
{
    return divide >= 4 ? 2 : divide >= 2;
}

/** Share of the pixels. */
static double share_of(int level)
{
    return 1.0 / (double)(1 << 2 * level);
}

void adcgs_time_left_add(adcgs_time_left *left, int divide, double seconds)
{
    double *cost = &left->cost[level_of(divide)];
    *cost = *cost > 0 ? KEEP * *cost + (1 - KEEP) * seconds : seconds;
}

/** Expected cost of an unmeasured level: on the line through two measured levels, or through one and the default overhead. */
static double expect(const adcgs_time_left *left, int level)
{
    int seen[ADCGS_TIME_LEFT_LEVELS], n = 0;
    for (int i = 0; i < ADCGS_TIME_LEFT_LEVELS; i++)
        if (left->cost[i] > 0)
            seen[n++] = i;
    if (!n)
        return (double)NAN;
    const double x = share_of(level), x0 = share_of(seen[0]), y0 = left->cost[seen[0]];
    const double usual = y0 * ((1 - OVERHEAD) * x + OVERHEAD) / ((1 - OVERHEAD) * x0 + OVERHEAD);
    if (n < 2)
        return usual;
    const double slope = (y0 - left->cost[seen[1]]) / (x0 - share_of(seen[1])), there = y0 + slope * (x - x0);
    /* More pixels cost at least as much, and at most in proportion. */
    return x > x0 ? fmin(fmax(there, y0), y0 * x / x0) : fmax(fmin(there, y0), y0 * x / x0);
}

/** Number of iterations that begin before a fraction of the run. */
static double count_until(const adcgs_train_config *c, double fraction)
{
    return ceil(fmin(fmax(fraction, 0), 1) * c->iterations);
}

double adcgs_time_left_of(const adcgs_time_left *left, const adcgs_train_config *c, uint32_t iteration, double elapsed)
{
    const double quarter = count_until(c, (double)c->quarter_size_until);
    const double ends[ADCGS_TIME_LEFT_LEVELS] = {c->iterations, fmax(count_until(c, (double)c->half_size_until), quarter),
                                                 quarter};
    double seconds = 0, at = iteration;
    for (int level = ADCGS_TIME_LEFT_LEVELS - 1; level >= 0; level--) {
        if (ends[level] <= at)
            continue;
        const double cost = left->cost[level] > 0 ? left->cost[level] : expect(left, level);
        seconds += (ends[level] - at) * cost + (at > iteration ? left->load : 0);
        at = ends[level];
    }
    if (c->time_limit > 0)
        seconds = fmin(seconds, fmax(c->time_limit - elapsed, 0)); /* also if seconds is NaN */
    return seconds;
}
