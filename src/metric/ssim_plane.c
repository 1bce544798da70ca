/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Structural similarity of one channel. The window is separable, so each of the
 * five moments is blurred along rows and then along columns. Only a ring of the
 * last eleven blurred rows is kept. The innermost loops run along a row.
 */
#include "config.h"

#include "metric/ssim_plane.h"

#include <math.h>

#define RADIUS ADCGS_SSIM_RADIUS
#define TAPS ADCGS_SSIM_TAPS
#define MOMENTS ADCGS_SSIM_MOMENTS
/* Literature: Wang, Bovik, Sheikh and Simoncelli, Image quality assessment, 2004. */
#define SIGMA 1.5        /* of the Gaussian window, pixels */
#define C1 (0.01 * 0.01) /* squared K1, for values 0..1 */
#define C2 (0.03 * 0.03) /* squared K2 */

adcgs_status adcgs_ssim_space_init(adcgs_ssim_space *space, int width, adcgs_error *error)
{
    double sum = 0.0;
    for (int i = 0; i < TAPS; i++)
        sum += space->window[i] = exp(-(i - RADIUS) * (i - RADIUS) / (2.0 * SIGMA * SIGMA));
    for (int i = 0; i < TAPS; i++)
        space->window[i] /= sum;
    space->ring = adcgs_alloc(NULL, (size_t)TAPS * MOMENTS * (size_t)width, sizeof *space->ring, error);
    space->padded = adcgs_alloc(NULL, MOMENTS * ((size_t)width + 2 * RADIUS), sizeof *space->padded, error);
    space->row = adcgs_alloc(NULL, MOMENTS * (size_t)width, sizeof *space->row, error);
    if (space->ring && space->padded && space->row)
        return ADCGS_OK;
    adcgs_ssim_space_clear(space);
    return adcgs_alloc_status(error);
}

void adcgs_ssim_space_clear(adcgs_ssim_space *space)
{
    adcgs_free(NULL, space->ring);
    adcgs_free(NULL, space->padded);
    adcgs_free(NULL, space->row);
    *space = (adcgs_ssim_space){.ring = NULL};
}

/** out += weight * in. */
static void add_scaled(double *restrict out, const double *restrict in, double weight, size_t n)
{
    for (size_t i = 0; i < n; i++)
        out[i] += weight * in[i];
}

static double *ring_row(const adcgs_ssim_space *s, int row, size_t width)
{
    return s->ring + (size_t)(row % TAPS) * MOMENTS * width;
}

/** Moments of one row, blurred along it; zeros beyond the image's edge. */
static void blur_row(const adcgs_ssim_space *s, const double *a, const double *b, int row, size_t width)
{
    const size_t stride = width + 2 * RADIUS;
    double *const out = ring_row(s, row, width);
    memset(s->padded, 0, MOMENTS * stride * sizeof *s->padded);
    for (size_t x = 0; x < width; x++) {
        double *p = s->padded + RADIUS + x;
        p[0] = a[x];
        p[stride] = b[x];
        p[2 * stride] = a[x] * a[x];
        p[3 * stride] = b[x] * b[x];
        p[4 * stride] = a[x] * b[x];
    }
    memset(out, 0, MOMENTS * width * sizeof *out);
    for (size_t m = 0; m < MOMENTS; m++)
        for (size_t t = 0; t < TAPS; t++)
            add_scaled(out + m * width, s->padded + m * stride + t, s->window[t], width);
}

/** Add the similarity of one pixel from its blurred moments, which are `stride` apart. */
static void add_pixel(adcgs_ssim_sums *sums, const double *m, size_t stride)
{
    const double a = m[0], b = m[stride];
    const double aa = m[2 * stride] - a * a, bb = m[3 * stride] - b * b, ab = m[4 * stride] - a * b;
    sums->similarity += (2.0 * a * b + C1) * (2.0 * ab + C2) / ((a * a + b * b + C1) * (aa + bb + C2));
    sums->structure += (2.0 * ab + C2) / (aa + bb + C2);
}

/** Sum over a row whose neighbours within the radius are in the ring. */
static void finish_row(const adcgs_ssim_space *s, adcgs_ssim_sums *sums, int row, size_t width, int height, size_t margin)
{
    const int first = ADCGS_MAX(row - RADIUS, 0), last = ADCGS_MIN(row + RADIUS, height - 1);
    adcgs_ssim_sums total = {0.0, 0.0};
    memset(s->row, 0, MOMENTS * width * sizeof *s->row);
    for (int y = first; y <= last; y++)
        add_scaled(s->row, ring_row(s, y, width), s->window[y - row + RADIUS], MOMENTS * width);
    const uint8_t *const hidden = s->hidden ? s->hidden + (size_t)row * width : NULL;
    for (size_t x = margin; x + margin < width; x++)
        if (!hidden || !hidden[x])
            add_pixel(&total, s->row + x, width);
    sums->similarity += total.similarity;
    sums->structure += total.structure;
}

adcgs_ssim_sums adcgs_ssim_plane(const adcgs_ssim_space *space, const double *a, const double *b, int width, int height,
                                 int margin)
{
    adcgs_ssim_sums sums = {0.0, 0.0};
    for (int y = 0; y < height + RADIUS; y++) {
        const size_t offset = (size_t)y * (size_t)width;
        const int done = y - RADIUS;
        if (y < height)
            blur_row(space, a + offset, b + offset, y, (size_t)width);
        if (done >= margin && done < height - margin)
            finish_row(space, &sums, done, (size_t)width, height, (size_t)margin);
    }
    return sums;
}
