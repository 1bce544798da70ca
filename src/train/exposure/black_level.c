/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Black levels of cameras. */
#include "train/exposure/black_level.h"

#include "system/sort_values.h"

#include <math.h>

/* Histogram of values up to 1/4: four bins per level of 255; arithmetic. */
enum { BINS = 256 };
static const float BIN = 1.0f / 1024; /* width of a bin, pixel values of 0 to 1 */
/* Values of 0 to 1; calibrated on zju313_15f, the only scene here that sees black (doc/log/exposure.md, "A black level"). */
static const float SPREAD = 4.0f / 255, /* maximum range of values that count as one black */
    MOST = 0.1f;                        /* maximum value of black; brighter content is merely dark */
static const double LEAST_SHARE = 0.01, /* share of the darkest pixels that are ignored in the range of values */
    SHARE = 0.2;                        /* share of the pixels that are used, the darkest */

/** Histogram of one channel of a camera. */
typedef struct histogram {
    uint64_t bin[BINS], n;
} histogram;

static adcgs_status gather(histogram (*of)[3], adcgs_trainer *t, adcgs_error *error)
{
    for (uint32_t i = 0; i < t->views.n; i++) {
        const adcgs_view *v = &t->views.list[i].view;
        const size_t plane = (size_t)v->width * (size_t)v->height;
        const uint8_t *const hidden = adcgs_image_store_mask(t->views.store, i);
        ADCGS_TRY(adcgs_image_store_get(t->views.store, i, t->taken, error));
        for (size_t c = 0; c < 3; c++) {
            histogram *h = &of[t->exposure.of[i]][c];
            const float *taken = t->taken + c * plane;
            for (size_t j = 0; j < plane; j++) {
                if (hidden && hidden[j])
                    continue;
                h->n++;
                if (taken[j] < BINS * BIN)
                    h->bin[(int)(fmaxf(taken[j], 0) / BIN)]++;
            }
        }
    }
    return ADCGS_OK;
}

/** Mean of the darkest fifth of the pixels; negative if they are not black. */
static float darkest(const histogram *h)
{
    const double until = SHARE * (double)h->n;
    double below = 0, sum = 0;
    int first = BINS;
    for (int i = 0; i < BINS; i++) {
        const double n = fmin((double)h->bin[i], until - below);
        below += n;
        sum += n * ((double)i + 0.5);
        if (first == BINS && below >= LEAST_SHARE * (double)h->n)
            first = i;
        if (below >= until)
            return (float)(i - first) * BIN <= SPREAD && (float)i * BIN <= MOST ? (float)(sum / until) * BIN : -1;
    }
    return -1;
}

/** level: buffer with one value per camera. */
static void set_levels(adcgs_exposure *e, histogram (*of)[3], double *level)
{
    for (uint32_t i = 0; i < e->n; i++)
        for (size_t c = 0; c < 3; c++)
            if ((e->cameras[i].black[c] = darkest(&of[i][c])) < 0)
                goto none;
    for (size_t c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < e->n; i++)
            level[i] = (double)e->cameras[i].black[c];
        adcgs_sort(level, e->n);
        for (uint32_t i = 0; i < e->n; i++)
            e->cameras[i].black[c] -= (float)level[e->n / 2];
    }
    return;
none:
    for (uint32_t i = 0; i < e->n; i++)
        memset(e->cameras[i].black, 0, sizeof e->cameras[i].black);
}

adcgs_status adcgs_black_levels(adcgs_trainer *t, adcgs_error *error)
{
    const uint32_t n = t->exposure.patient || !t->config.black_levels ? 0 : t->exposure.n;
    if (!n)
        return ADCGS_OK;
    histogram(*of)[3] = adcgs_alloc(NULL, n, sizeof *of, error);
    double *level = adcgs_alloc(NULL, n, sizeof *level, error);
    adcgs_status status = of && level ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        memset(of, 0, n * sizeof *of);
        status = gather(of, t, error);
    }
    if (status == ADCGS_OK)
        set_levels(&t->exposure, of, level);
    adcgs_free(NULL, level);
    adcgs_free(NULL, of);
    return status;
}
