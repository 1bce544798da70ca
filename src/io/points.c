/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Point clouds in memory. */
#include "config.h"

#include "io/points.h"

#include <stdlib.h>

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
