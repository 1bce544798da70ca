/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Structural similarity at one scale and at several. */
#include "config.h"

#include "metric/metric.h"
#include "metric/ssim_plane.h"

#include <math.h>

/** Exponents of the scales; literature: Wang, Simoncelli and Bovik, Multiscale structural similarity, 2003. */
static const double WEIGHTS[ADCGS_MS_SSIM_SCALES] = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

/** Two planes, and the scratch memory to compare them. */
typedef struct pair {
    adcgs_ssim_space space;
    double *a, *b;
    int width, height;
} pair;

static void pair_clear(pair *p)
{
    adcgs_ssim_space_clear(&p->space);
    adcgs_free(NULL, p->a);
    adcgs_free(NULL, p->b);
}

static adcgs_status pair_init(pair *p, int width, int height, adcgs_error *error)
{
    *p = (pair){.width = width, .height = height};
    if (width < 1 || height < 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "SSIM of an image of %dx%d pixels", width, height);
    const size_t plane = (size_t)width * (size_t)height;
    p->a = adcgs_alloc(NULL, plane, sizeof *p->a, error);
    p->b = adcgs_alloc(NULL, plane, sizeof *p->b, error);
    adcgs_status status = p->a && p->b ? adcgs_ssim_space_init(&p->space, width, error) : adcgs_alloc_status(error);
    if (status != ADCGS_OK)
        pair_clear(p);
    return status;
}

/** Copy channel c of two images, which are as large as in pair_init(). */
static void pair_fill(pair *p, const float *a, const float *b, int width, int height, size_t c)
{
    const size_t plane = (size_t)width * (size_t)height;
    p->width = width;
    p->height = height;
    for (size_t i = 0; i < plane; i++) {
        p->a[i] = (double)a[c * plane + i];
        p->b[i] = isnan(b[c * plane + i]) ? p->a[i] : (double)b[c * plane + i];
    }
}

/** Mark the unknown pixels of an image. \return the number of known pixels */
static size_t find_hidden(uint8_t *hidden, const float *picture, size_t plane)
{
    size_t known = 0;
    for (size_t i = 0; i < plane; i++) {
        hidden[i] = isnan(picture[i]) != 0;
        known += !hidden[i];
    }
    return known;
}

adcgs_status adcgs_ssim(const float *a, const float *b, int width, int height, double *ssim, adcgs_error *error)
{
    pair p;
    double total = 0.0;
    ADCGS_TRY(pair_init(&p, width, height, error));
    const size_t plane = (size_t)width * (size_t)height;
    uint8_t *hidden = adcgs_alloc(NULL, plane, 1, error);
    if (!hidden) {
        pair_clear(&p);
        return adcgs_alloc_status(error);
    }
    const size_t known = find_hidden(hidden, b, plane);
    p.space.hidden = known < plane ? hidden : NULL;
    for (size_t c = 0; c < 3; c++) {
        pair_fill(&p, a, b, width, height, c);
        total += adcgs_ssim_plane(&p.space, p.a, p.b, width, height, 0).similarity;
    }
    pair_clear(&p);
    adcgs_free(NULL, hidden);
    *ssim = known ? total / (3.0 * (double)known) : 1.0;
    return ADCGS_OK;
}

/** Mean of the pixels of a plane that a box of 2x2 covers. In place: no box is read after it has been overwritten. */
static void halve(double *plane, int width, int height)
{
    double *out = plane;
    for (int y = 0; y < height; y += 2)
        for (int x = 0; x < width; x += 2) {
            const int right = x + 1 < width, below = y + 1 < height;
            const double *in = plane + (size_t)y * (size_t)width + (size_t)x;
            double sum = in[0] + (right ? in[1] : 0.0);
            if (below)
                sum += in[width] + (right ? in[width + 1] : 0.0);
            *out++ = sum / ((1 + right) * (1 + below));
        }
}

static void pair_halve(pair *p)
{
    halve(p->a, p->width, p->height);
    halve(p->b, p->width, p->height);
    p->width = (p->width + 1) / 2;
    p->height = (p->height + 1) / 2;
}

/** Product over the scales of one channel. */
static double measure_scales(pair *p, int n, double weights)
{
    double product = 1.0;
    for (int i = 0; i < n; i++) {
        if (i)
            pair_halve(p);
        const adcgs_ssim_sums sums = adcgs_ssim_plane(&p->space, p->a, p->b, p->width, p->height, ADCGS_SSIM_RADIUS);
        const double pixels = (double)(p->width - 2 * ADCGS_SSIM_RADIUS) * (double)(p->height - 2 * ADCGS_SSIM_RADIUS);
        const double mean = (i + 1 < n ? sums.structure : sums.similarity) / pixels;
        product *= pow(mean < 0.0 ? 0.0 : mean, WEIGHTS[i] / weights);
    }
    return product;
}

static int count_scales(int width, int height)
{
    int n = 0, side = ADCGS_MIN(width, height);
    for (; n < ADCGS_MS_SSIM_SCALES && side >= ADCGS_SSIM_TAPS; n++)
        side = (side + 1) / 2;
    return n;
}

adcgs_status adcgs_ms_ssim(const float *a, const float *b, int width, int height, double *ms_ssim, int *scales,
                           adcgs_error *error)
{
    pair p;
    double total = 0.0, weights = 0.0;
    const int n = count_scales(width, height);
    ADCGS_TRY(pair_init(&p, width, height, error));
    for (int i = 0; i < n; i++)
        weights += WEIGHTS[i];
    for (size_t c = 0; c < 3 && n; c++) {
        pair_fill(&p, a, b, width, height, c);
        total += measure_scales(&p, n, n < ADCGS_MS_SSIM_SCALES ? weights : 1.0);
    }
    pair_clear(&p);
    *ms_ssim = n ? total / 3.0 : (double)NAN;
    *scales = n;
    return ADCGS_OK;
}
