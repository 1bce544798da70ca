/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * The time table as a smooth curve (spec clause "Time"): a uniform cubic B-spline of its rows. Its motion has no corners, while
 * linear interpolation has one at each row. Neighbouring times share rows, so they are trained together. Beyond the first and
 * last rows the curve is extrapolated linearly, so that it begins and ends at these rows.
 */
#ifndef ADCGS_SPLAT_TIME_CURVE_H
#define ADCGS_SPLAT_TIME_CURVE_H

#include "base/fmath.h"

/** The rows around t in [0,1]: row, the next, one before and one after, which may not exist; and their weights. */
typedef struct adcgs_time_place {
    uint32_t row;
    float fraction;  /**< position between row and the next row */
    float weight[4]; /**< of rows row - 1 .. row + 2, on the smooth curve */
} adcgs_time_place;

/** rows: at least 2. */
static inline adcgs_time_place adcgs_time_place_of(float t, uint32_t rows)
{
    const float u = t * (float)(rows - 1);
    const uint32_t row = (uint32_t)u < rows - 2 ? (uint32_t)u : rows - 2;
    const float r = u - (float)row, s = 1 - r, sixth = 0x1.555556p-3f, two_thirds = 0x1.555556p-1f;
    return (adcgs_time_place){row,
                              r,
                              {s * s * s * sixth, fmaf(r * r, fmaf(0.5f, r, -1), two_thirds),
                               fmaf(s * s, fmaf(0.5f, s, -1), two_thirds), r * r * r * sixth}};
}

/** Extrapolate a row that does not exist, from the last row that does and the row before it. */
static inline float adcgs_time_beyond(float last, float before)
{
    return fmaf(2, last, -before);
}

/** Blend rows row - 1 .. row + 2 by their weights. */
static inline float adcgs_time_blend(const float weight[4], float a, float b, float c, float d)
{
    return fmaf(weight[3], d, fmaf(weight[2], c, fmaf(weight[1], b, weight[0] * a)));
}

#endif
