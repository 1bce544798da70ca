/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Contrast of a scene, and its effect on lambda. */
#include "train/exposure/contrast.h"

#include "train/resolve.h"

#include <math.h>

enum { PICTURES_MOST = 64 }; /* maximum number of images for the contrast; chosen by hand, not measured */
/** Bounds of lambda's factor; images of one colour still need a positive lambda. Ratios, chosen by hand, not measured. */
static const double LEAST = 0.1, MOST = 4;

adcgs_status adcgs_contrast(const adcgs_trainer *t, double *contrast, adcgs_error *error)
{
    const uint32_t n = ADCGS_MIN(t->views.n, PICTURES_MOST);
    double sum[3] = {0, 0, 0}, square = 0, count = 0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t view = (uint32_t)((uint64_t)i * t->views.n / n);
        const adcgs_view *v = &t->views.list[view].view;
        const size_t plane = (size_t)v->width * (size_t)v->height;
        ADCGS_TRY(adcgs_image_store_get(t->views.store, view, t->taken, error));
        for (size_t c = 0; c < 3; c++)
            for (size_t j = c * plane; j < (c + 1) * plane; j++) {
                if (isnan(t->taken[j])) /* masked, or outside the lens's field */
                    continue;
                sum[c] += (double)t->taken[j];
                square += (double)t->taken[j] * (double)t->taken[j];
                count += c == 0;
            }
    }
    double about = 0;
    for (int c = 0; c < 3; c++)
        about += sum[c] / fmax(count, 1) * (sum[c] / fmax(count, 1));
    *contrast = sqrt(fmax(square / fmax(count, 1) - about, 0) / 3);
    return ADCGS_OK;
}

static double find_lambda(adcgs_trainer *t)
{
    return adcgs_resolve_contrast(&t->config, fmin(fmax(t->rate.contrast / ADCGS_CONTRAST_NOMINAL, LEAST), MOST));
}

void adcgs_contrast_record(adcgs_trainer *t)
{
    if (t->rate.contrast > 0)
        find_lambda(t);
}

adcgs_status adcgs_contrast_lambda(adcgs_trainer *t, adcgs_error *error)
{
    if (!(t->rate.contrast > 0))
        ADCGS_TRY(adcgs_contrast(t, &t->rate.contrast, error));
    t->rate.lambda = find_lambda(t);
    return ADCGS_OK;
}
