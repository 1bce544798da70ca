/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds in memory. */
#include "config.h"

#include "media/points/points.h"

#include "system/median.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define ROUND_LOOKS 1001 /* number of points that estimate the cloud's position and size */
#define ROUND_FAR 64.0   /* distance from the origin over the size, above which 24 bits of a coordinate are too few */

adcgs_status adcgs_points_alloc(adcgs_points *points, uint64_t n, const char *path, adcgs_error *error)
{
    *points = (adcgs_points){0};
    if (n > ADCGS_POINTS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %llu points, expected at most %u", path, (unsigned long long)n,
                          ADCGS_POINTS_MAX);
    const size_t count = (size_t)n + !n;
    points->position = malloc(count * sizeof *points->position);
    points->colour = malloc(count * sizeof *points->colour);
    if (!points->position || !points->colour) {
        adcgs_points_free(points);
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %llu points", path, (unsigned long long)n);
    }
    memset(points->colour, 128, count * sizeof *points->colour);
    points->n = (uint32_t)n;
    return ADCGS_OK;
}

void adcgs_points_free(adcgs_points *points)
{
    free(points->position);
    free(points->colour);
    *points = (adcgs_points){0};
}

/* ---- Far from the origin ---- */

/** True for a cloud far from the origin. Medians ignore a few outliers. */
static int is_far(const adcgs_points *points)
{
    const uint32_t n = ADCGS_MIN(points->n, ROUND_LOOKS);
    double middle[3], values[ROUND_LOOKS], distance = 0.0;
    for (int a = 0; a < 3; a++) {
        for (uint32_t i = 0; i < n; i++)
            values[i] = points->position[(uint64_t)i * points->n / n][a];
        middle[a] = adcgs_median(values, n);
        distance = fmax(distance, fabs(middle[a]));
    }
    for (uint32_t i = 0; i < n; i++) {
        const double *const x = points->position[(uint64_t)i * points->n / n];
        values[i] = fmax(fabs(x[0] - middle[0]), fmax(fabs(x[1] - middle[1]), fabs(x[2] - middle[2])));
    }
    const double size = adcgs_median(values, n);
    return size > 0.0 && distance > ROUND_FAR * size;
}

void adcgs_points_round(adcgs_points *points)
{
    if (!points->n || is_far(points))
        return;
    double *const x = (double *)points->position; /* one loop: of two nested ones, gcc 12 with -O3 leaves the last rows
                                                     unrounded */
    for (size_t i = 0; i < 3 * (size_t)points->n; i++)
        x[i] = (double)(float)x[i];
}
