/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The amount of detail in an image. */
#include "metric/detail.h"

#include <math.h>

static void take_luma(double *out, const float *picture, size_t plane)
{
    for (size_t i = 0; i < plane; i++) {
        const double red = (double)picture[i], green = (double)picture[plane + i], blue = (double)picture[2 * plane + i];
        const double luma = 0.299 * red + 0.587 * green + 0.114 * blue;
        out[i] = isnan(luma) ? 0.5 : luma;
    }
}

/**
 * One scale: counts the details above the bound. Leaves an image of half the size in place, without the last row or column of an
 * uneven size.
 */
static uint32_t halve(double *picture, int width, int height)
{
    const size_t row = (size_t)width, half = row / 2;
    uint32_t n = 0;
    for (size_t y = 0; y < (size_t)height / 2; y++)
        for (size_t x = 0; x < half; x++) {
            const double *const top = picture + 2 * y * row + 2 * x, *const low = top + row;
            n += fabs(top[0] - top[1] + low[0] - low[1]) > 2 * ADCGS_DETAIL_LEAST;
            n += fabs(top[0] + top[1] - low[0] - low[1]) > 2 * ADCGS_DETAIL_LEAST;
            n += fabs(top[0] - top[1] - low[0] + low[1]) > 2 * ADCGS_DETAIL_LEAST;
            picture[y * half + x] = (top[0] + top[1] + low[0] + low[1]) / 2;
        }
    return n;
}

adcgs_status adcgs_detail(const float *picture, int width, int height, uint32_t *details, adcgs_error *error)
{
    const size_t plane = (size_t)width * (size_t)height;
    double *const luma = adcgs_alloc(NULL, plane, sizeof *luma, error);
    *details = 0;
    if (!luma)
        return adcgs_alloc_status(error);
    take_luma(luma, picture, plane);
    for (; width > 1 && height > 1; width /= 2, height /= 2)
        *details += halve(luma, width, height);
    adcgs_free(NULL, luma);
    return ADCGS_OK;
}
