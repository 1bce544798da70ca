/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures at a glance. */
#include "config.h"

#include "data/glance.h"

#include "data/sort.h"

#include <math.h>
#include <stddef.h>

#define DARK 0.02f  /* black levels and rounding have their say below */
#define LIGHT 0.95f /* what is cut off at white does not brighten any more */
#define FEW 32      /* cells: fewer are one thing, not the light */

/** Mean of the pixels from x0 to x1 in rows y0 to y1; NaN where less than half of them are known. */
static float mean_of(const float *rgb, size_t width, size_t height, size_t x0, size_t x1, size_t y0, size_t y1)
{
    const size_t plane = width * height;
    double sum = 0.0;
    size_t known = 0;
    for (size_t y = y0; y < y1; y++)
        for (size_t i = y * width + x0; i < y * width + x1; i++) {
            const float grey = rgb[i] + rgb[plane + i] + rgb[2 * plane + i];
            if (isnan(grey))
                continue;
            sum += (double)grey;
            known++;
        }
    return known && 2 * known >= (x1 - x0) * (y1 - y0) ? (float)(sum / (3.0 * (double)known)) : (float)NAN;
}

void adcgs_glance_take(adcgs_glance *glance, const float *rgb, int width, int height)
{
    const size_t side = ADCGS_GLANCE_SIDE, w = (size_t)width, h = (size_t)height;
    for (size_t y = 0; y < side; y++)
        for (size_t x = 0; x < side; x++) /* of a picture that is smaller some cells have no pixel */
            glance->cells[y * side + x] = mean_of(rgb, w, h, x * w / side, (x + 1) * w / side, y * h / side, (y + 1) * h / side);
}

double adcgs_glance_difference(const adcgs_glance *a, const adcgs_glance *b)
{
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < ADCGS_GLANCE_CELLS; i++) {
        const float difference = fabsf(a->cells[i] - b->cells[i]);
        if (isnan(difference))
            continue;
        sum += (double)difference;
        n++;
    }
    return n ? sum / n : (double)NAN;
}

double adcgs_glance_brighter(const adcgs_glance *a, const adcgs_glance *b, double *spread)
{
    double ratios[ADCGS_GLANCE_CELLS];
    size_t n = 0;
    for (int i = 0; i < ADCGS_GLANCE_CELLS; i++) {
        const float x = a->cells[i], y = b->cells[i];
        if (x > DARK && y > DARK && x < LIGHT && y < LIGHT)
            ratios[n++] = log((double)y / (double)x);
    }
    *spread = (double)NAN;
    if (n < FEW)
        return (double)NAN;
    adcgs_sort(ratios, n);
    const double median = ratios[n / 2];
    for (size_t i = 0; i < n; i++)
        ratios[i] = fabs(ratios[i] - median);
    adcgs_sort(ratios, n);
    *spread = ratios[n / 2];
    return median;
}
