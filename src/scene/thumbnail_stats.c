/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Thumbnails of images. */
#include "config.h"

#include "scene/thumbnail_stats.h"

#include "system/sort_values.h"

#include <math.h>
#include <stddef.h>

/*
 * Cells of 0 to 1; chosen by hand, and checked on 46 generated scenes and six others without faults, and on faults of known
 * strength (doc/log/stability.md, "Warnings about footage").
 */
#define DARK 0.02  /* least value of a cell: black level and rounding dominate below */
#define LIGHT 0.95 /* largest value of a cell: clipped values do not become brighter */
#define FEW 32     /* least number of cells: fewer are one object, not the light */

/** Means of the channels over pixels x0 to x1 of rows y0 to y1; NaN if less than half of these pixels are known. */
static void mean_of(double mean[3], const float *rgb, size_t width, size_t height, size_t x0, size_t x1, size_t y0, size_t y1)
{
    const size_t plane = width * height;
    double sum[3] = {0.0, 0.0, 0.0};
    size_t known = 0;
    for (size_t y = y0; y < y1; y++)
        for (size_t i = y * width + x0; i < y * width + x1; i++) {
            if (isnan(rgb[i] + rgb[plane + i] + rgb[2 * plane + i]))
                continue;
            for (size_t c = 0; c < 3; c++)
                sum[c] += (double)rgb[c * plane + i];
            known++;
        }
    for (int c = 0; c < 3; c++)
        mean[c] = known && 2 * known >= (x1 - x0) * (y1 - y0) ? sum[c] / (double)known : (double)NAN;
}

static int is_lit(double value)
{
    return value > DARK && value < LIGHT;
}

void adcgs_thumbnail_compute(adcgs_thumbnail *thumbnail, const float *rgb, int width, int height)
{
    const size_t side = ADCGS_THUMBNAIL_SIDE, w = (size_t)width, h = (size_t)height;
    double tints[ADCGS_THUMBNAIL_TINTS][3] = {{0.0}}, mean[3];
    for (size_t y = 0; y < side; y++)
        for (size_t x = 0; x < side; x++) { /* some cells of a smaller image have no pixel */
            double *const tint = tints[y / 2 * ADCGS_THUMBNAIL_TINT_SIDE + x / 2];
            mean_of(mean, rgb, w, h, x * w / side, (x + 1) * w / side, y * h / side, (y + 1) * h / side);
            thumbnail->cells[y * side + x] = (float)((mean[0] + mean[1] + mean[2]) / 3.0);
            for (int c = 0; c < 3; c++)
                tint[c] += 0.25 * mean[c];
        }
    for (int i = 0; i < ADCGS_THUMBNAIL_TINTS; i++)
        for (int c = 0; c < 2; c++) {
            const double green = tints[i][1], other = tints[i][2 * c];
            thumbnail->tints[c][i] = is_lit(green) && is_lit(other) ? (float)log(other / green) : (float)NAN;
        }
}

double adcgs_thumbnail_difference(const adcgs_thumbnail *a, const adcgs_thumbnail *b)
{
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < ADCGS_THUMBNAIL_CELLS; i++) {
        const float difference = fabsf(a->cells[i] - b->cells[i]);
        if (isnan(difference))
            continue;
        sum += (double)difference;
        n++;
    }
    return n ? sum / n : (double)NAN;
}

/** Logarithms of the ratios of usable cells; returns their number. */
static size_t take_ratios(double *ratios, const adcgs_thumbnail *a, const adcgs_thumbnail *b, adcgs_thumbnail_light light)
{
    size_t n = 0;
    if (light == ADCGS_LIGHT_BRIGHTER) {
        for (int i = 0; i < ADCGS_THUMBNAIL_CELLS; i++)
            if (is_lit((double)a->cells[i]) && is_lit((double)b->cells[i]))
                ratios[n++] = log((double)b->cells[i] / (double)a->cells[i]);
        return n;
    }
    const float *const x = a->tints[light - ADCGS_LIGHT_REDDER], *const y = b->tints[light - ADCGS_LIGHT_REDDER];
    for (int i = 0; i < ADCGS_THUMBNAIL_TINTS; i++)
        if (!isnan(y[i] - x[i]))
            ratios[n++] = (double)y[i] - (double)x[i];
    return n;
}

double adcgs_thumbnail_compare(const adcgs_thumbnail *a, const adcgs_thumbnail *b, adcgs_thumbnail_light light, double *spread)
{
    double ratios[ADCGS_THUMBNAIL_CELLS];
    const size_t n = take_ratios(ratios, a, b, light);
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

/** Mean colour of a cell with known tints, from its four grey cells and the tints. */
static void colour_of(double colour[3], const adcgs_thumbnail *thumbnail, int cell)
{
    const int side = ADCGS_THUMBNAIL_SIDE,
              at = cell / ADCGS_THUMBNAIL_TINT_SIDE * 2 * side + cell % ADCGS_THUMBNAIL_TINT_SIDE * 2;
    const float *const grey = thumbnail->cells + at;
    const double red = exp((double)thumbnail->tints[0][cell]), blue = exp((double)thumbnail->tints[1][cell]);
    colour[1] = 0.75 * ((double)grey[0] + (double)grey[1] + (double)grey[side] + (double)grey[side + 1]) / (red + 1.0 + blue);
    colour[0] = red * colour[1];
    colour[2] = blue * colour[1];
}

void adcgs_thumbnail_gains(const adcgs_thumbnail *a, const adcgs_thumbnail *b, double gains[3])
{
    double ratios[3][ADCGS_THUMBNAIL_TINTS], x[3], y[3];
    size_t n = 0;
    for (int i = 0; i < ADCGS_THUMBNAIL_TINTS; i++) {
        colour_of(x, a, i);
        colour_of(y, b, i);
        if (isnan(x[0] + x[2] + y[0] + y[2]))
            continue;
        for (int c = 0; c < 3; c++)
            ratios[c][n] = log(y[c] / x[c]);
        n++;
    }
    for (int c = 0; c < 3; c++) {
        adcgs_sort(ratios[c], n);
        gains[c] = n < FEW ? (double)NAN : ratios[c][n / 2];
    }
}
