/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Brightness of the training images. */
#include "train/exposure/brightness.h"

#include <math.h>

/*
 * Minimum difference from the background, summed over the channels, of an object's pixel in images with alpha; pixel values of 0
 * to 1, chosen by hand, not measured.
 */
static const float OBJECT = 0.03f;

/** Sum and number of a camera's pixel values. */
typedef struct amount {
    double sum, n;
} amount;

static void add_image(amount *of, const adcgs_trainer *t, const float *taken, const uint8_t *hidden, size_t plane)
{
    for (size_t i = 0; i < plane; i++) {
        float off = 0, value = 0, most = 0;
        for (size_t c = 0; c < 3; c++) {
            const float here = taken[c * plane + i];
            off += fabsf(here - t->scene->background[c]);
            most = fmaxf(most, here);
            value += here;
        }
        if ((hidden && hidden[i]) || most >= ADCGS_BURNT || (t->scene->has_alpha && off < OBJECT))
            continue;
        of->sum += (double)value;
        of->n++;
    }
}

adcgs_status adcgs_bound_gains(adcgs_trainer *t, adcgs_error *error)
{
    adcgs_exposure *const e = &t->exposure;
    if (!t->config.gains)
        e->limit = 0;
    if (!e->n || !t->config.gains)
        return ADCGS_OK;
    amount *of = adcgs_alloc(NULL, e->n, sizeof *of, error);
    double *brightness = adcgs_alloc(NULL, e->n, sizeof *brightness, error);
    adcgs_status status = of && brightness ? ADCGS_OK : adcgs_alloc_status(error);
    for (uint32_t i = 0; status == ADCGS_OK && i < e->n; i++)
        of[i] = (amount){0, 0};
    for (uint32_t i = 0; status == ADCGS_OK && i < t->views.n; i++) {
        const adcgs_view *v = &t->views.list[i].view;
        status = adcgs_image_store_get(t->views.store, i, t->taken, error);
        if (status == ADCGS_OK)
            add_image(&of[e->of[i]], t, t->taken, adcgs_image_store_mask(t->views.store, i),
                      (size_t)v->width * (size_t)v->height);
    }
    for (uint32_t i = 0; status == ADCGS_OK && i < e->n; i++)
        brightness[i] = of[i].n > 0 ? of[i].sum / of[i].n : 0;
    if (status == ADCGS_OK)
        adcgs_exposure_bound(e, brightness);
    adcgs_free(NULL, brightness);
    adcgs_free(NULL, of);
    return status;
}
