/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Structural similarity. The window is separable, so each of the five moments
 * is blurred along rows and then along columns; a ring of the last eleven
 * blurred rows is all that is kept.
 */
#include "config.h"

#include "metric/metric.h"

#include <math.h>
#include <stdlib.h>

#define RADIUS 5
#define TAPS (2 * RADIUS + 1)
#define SIGMA 1.5
#define C1 (0.01 * 0.01)
#define C2 (0.03 * 0.03)
#define MOMENTS 5 /* a, b, aa, bb, ab */

typedef struct state {
    int width, height;
    double window[TAPS];
    double *ring;   /* [TAPS][MOMENTS][width] */
    double *padded; /* [MOMENTS][width + 2 RADIUS] */
} state;

static void make_window(double window[TAPS])
{
    double sum = 0.0;
    for (int i = 0; i < TAPS; i++)
        sum += window[i] = exp(-(i - RADIUS) * (i - RADIUS) / (2.0 * SIGMA * SIGMA));
    for (int i = 0; i < TAPS; i++)
        window[i] /= sum;
}

static double *ring_row(const state *s, int row, int moment)
{
    return s->ring + ((size_t)(row % TAPS) * MOMENTS + (size_t)moment) * (size_t)s->width;
}

/** Moments of one row, blurred along it; zeros beyond the picture's edge. */
static void blur_row(const state *s, const float *a, const float *b, int row)
{
    const size_t stride = (size_t)s->width + 2 * RADIUS;
    for (int x = 0; x < s->width; x++) {
        const double va = (double)a[x], vb = (double)b[x];
        double *p = s->padded + RADIUS + x;
        p[0] = va;
        p[stride] = vb;
        p[2 * stride] = va * va;
        p[3 * stride] = vb * vb;
        p[4 * stride] = va * vb;
    }
    for (int m = 0; m < MOMENTS; m++) {
        const double *in = s->padded + (size_t)m * stride;
        double *out = ring_row(s, row, m);
        for (int x = 0; x < s->width; x++) {
            double sum = 0.0;
            for (int t = 0; t < TAPS; t++)
                sum += s->window[t] * in[x + t];
            out[x] = sum;
        }
    }
}

/** Similarity of one pixel from its blurred moments. */
static double similarity(const double m[MOMENTS])
{
    const double aa = m[2] - m[0] * m[0], bb = m[3] - m[1] * m[1], ab = m[4] - m[0] * m[1];
    return (2.0 * m[0] * m[1] + C1) * (2.0 * ab + C2) / ((m[0] * m[0] + m[1] * m[1] + C1) * (aa + bb + C2));
}

/** Sum over a row whose neighbours within the radius are in the ring. */
static double finish_row(const state *s, int row)
{
    const int first = ADCGS_MAX(row - RADIUS, 0), last = ADCGS_MIN(row + RADIUS, s->height - 1);
    double total = 0.0;
    for (int x = 0; x < s->width; x++) {
        double moments[MOMENTS] = {0.0};
        for (int y = first; y <= last; y++)
            for (int m = 0; m < MOMENTS; m++)
                moments[m] += s->window[y - row + RADIUS] * ring_row(s, y, m)[x];
        total += similarity(moments);
    }
    return total;
}

static double plane_sum(const state *s, const float *a, const float *b)
{
    double total = 0.0;
    for (int y = 0; y < s->height + RADIUS; y++) {
        const size_t offset = (size_t)y * (size_t)s->width;
        if (y < s->height)
            blur_row(s, a + offset, b + offset, y);
        if (y >= RADIUS)
            total += finish_row(s, y - RADIUS);
    }
    return total;
}

adcgs_status adcgs_ssim(const float *a, const float *b, int width, int height, double *ssim, adcgs_error *error)
{
    if (width < 1 || height < 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "SSIM of a picture of %dx%d pixels", width, height);
    const size_t plane = (size_t)width * (size_t)height;
    state s = {.width = width, .height = height};
    make_window(s.window);
    s.ring = malloc((size_t)TAPS * MOMENTS * (size_t)width * sizeof *s.ring);
    s.padded = calloc(MOMENTS * ((size_t)width + 2 * RADIUS), sizeof *s.padded);
    double total = 0.0;
    if (s.ring && s.padded)
        for (size_t c = 0; c < 3; c++)
            total += plane_sum(&s, a + c * plane, b + c * plane);
    const int out_of_memory = !s.ring || !s.padded;
    free(s.ring);
    free(s.padded);
    if (out_of_memory)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for SSIM of %dx%d pixels", width, height);
    *ssim = total / (3.0 * (double)plane);
    return ADCGS_OK;
}
