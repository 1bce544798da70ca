/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Exposure of cameras. */
#include "train/exposure/exposure.h"

#include "scene/group_views.h"
#include "system/sort_values.h"

#include <math.h>

enum { PICTURES_LEAST = 4 }; /* minimum mean number of images per camera; chosen by hand, not measured */
static const double
    /* Decay of the sums from one image of a camera to its next; chosen by hand, not measured. */
    KEEP = 0.9,
    /*
     * The same if each image is its own camera, seen once per epoch. With KEEP the sums would lag by hundreds of iterations.
     * Chosen by hand, not measured: gains follow within two epochs instead of ten.
     */
    KEEP_PATIENT = 0.3,
    /*
     * |log gain| below which it counts as none, like a Laplace prior. View-dependent light alone causes values of 0.1. Calibrated
     * on the demo, whose equal cameras are found within 2.7 % (doc/log/exposure.md, "Gains of cameras").
     */
    DOUBT = 0.03;
static const float GAIN_MOST = 4; /* maximum gain and reciprocal of the minimum; chosen by hand, not measured */
/*
 * Logarithm by which a gain may exceed the range of the images' brightness, because their contents differ, too; chosen by hand,
 * not measured.
 */
static const double SLACK = 0.1;
/* Maximum difference of each channel from the background, for a pixel of the background: one level of 255, arithmetic. */
static const float BACKDROP = 0.004f;

adcgs_status adcgs_exposure_create(adcgs_exposure *e, const adcgs_scene_view *views, uint32_t n_views, int still,
                                   adcgs_error *error)
{
    const uint32_t most = n_views / PICTURES_LEAST;
    adcgs_exposure_clear(e);
    e->of = adcgs_alloc(NULL, n_views, sizeof *e->of, error);
    uint32_t n = 0;
    if (!e->of)
        return adcgs_alloc_status(error);
    ADCGS_TRY(adcgs_group_views(views, n_views, e->of, NULL, &n, error));
    if (n < 2 || (n > most && !still))
        return ADCGS_OK;
    e->cameras = adcgs_alloc(NULL, n, sizeof *e->cameras, error);
    if (!e->cameras)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++)
        e->cameras[i] = (adcgs_exposure_camera){.gain = {1, 1, 1}};
    e->n = n;
    e->patient = n > most;
    e->limit = logf(GAIN_MOST);
    return ADCGS_OK;
}

void adcgs_exposure_clear(adcgs_exposure *e)
{
    adcgs_free(NULL, e->of);
    adcgs_free(NULL, e->cameras);
    *e = (adcgs_exposure){.n = 0};
}

void adcgs_exposure_walk(adcgs_checkpoint_walk *walk, adcgs_exposure *e)
{
    if (e->n)
        adcgs_checkpoint_visit(walk, &e->limit, sizeof e->limit);
    for (uint32_t i = 0; i < e->n; i++)
        adcgs_checkpoint_visit(walk, &e->cameras[i], sizeof e->cameras[i]);
}

void adcgs_exposure_sum(const adcgs_exposure *e, uint32_t view, const float *drawn, const float *taken, size_t plane,
                        adcgs_exposure_sums *sums)
{
    const adcgs_exposure_camera *camera = &e->cameras[e->of[view]];
    for (size_t c = 0; c < 3; c++, drawn += plane, taken += plane) {
        double cross = 0, square = 0;
        for (size_t i = 0; i < plane; i++)
            if (taken[i] < ADCGS_BURNT) {
                cross += (double)drawn[i] * (double)(taken[i] - camera->black[c]);
                square += (double)drawn[i] * (double)drawn[i];
            }
        sums->cross[c] = cross;
        sums->square[c] = square;
    }
}

void adcgs_exposure_follow(adcgs_exposure *e, uint32_t view, const adcgs_exposure_sums *sums)
{
    adcgs_exposure_camera *camera = &e->cameras[e->of[view]];
    const double keep = e->patient ? KEEP_PATIENT : KEEP;
    for (size_t c = 0; c < 3; c++) {
        camera->cross[c] = keep * camera->cross[c] + sums->cross[c];
        camera->square[c] = keep * camera->square[c] + sums->square[c];
        if (camera->cross[c] > 0 && camera->square[c] > 0)
            camera->gain[c] = fminf(fmaxf((float)(camera->cross[c] / camera->square[c]), 1 / GAIN_MOST), GAIN_MOST);
    }
}

/** Factor by which a camera's images exceed those of the mean camera. A part that may be an error of the model is removed. */
static float excess(const adcgs_exposure *e, uint32_t camera, size_t channel)
{
    double mean = 0;
    for (uint32_t i = 0; i < e->n; i++)
        mean += log((double)e->cameras[i].gain[channel]) / e->n;
    const double off = log((double)e->cameras[camera].gain[channel]) - mean;
    const double sure = off > DOUBT ? off - DOUBT : off < -DOUBT ? off + DOUBT : 0, limit = (double)e->limit;
    return (float)exp(fmin(fmax(sure, -limit), limit));
}

void adcgs_exposure_bound(adcgs_exposure *e, double *brightness)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < e->n; i++)
        if (brightness[i] > 0)
            brightness[n++] = log(brightness[i]);
    adcgs_sort(brightness, n);
    if (!n)
        return;
    const double middle = brightness[n / 2];
    e->limit = (float)fmin(fmax(middle - brightness[0], brightness[n - 1] - middle) + SLACK, log((double)GAIN_MOST));
}

static int all_followed(const adcgs_exposure *e)
{
    for (uint32_t i = 0; i < e->n; i++)
        if (!(e->cameras[i].square[0] > 0))
            return 0;
    return 1;
}

void adcgs_exposure_even(const adcgs_exposure *e, uint32_t view, const float *taken, float *out, size_t plane)
{
    const int told = !e->patient || all_followed(e);
    for (size_t c = 0; c < 3; c++) {
        const float by = told ? 1 / excess(e, e->of[view], c) : 1, black = e->cameras[e->of[view]].black[c];
        for (size_t i = c * plane; i < (c + 1) * plane; i++)
            out[i] = by * (taken[i] - black);
    }
}

/** True if a pixel of a target shows only the background. */
static int is_backdrop(const float *target, size_t plane, const float backdrop[3])
{
    int same = 1;
    for (size_t c = 0; c < 3; c++)
        same &= fabsf(target[c * plane] - backdrop[c]) < BACKDROP;
    return same;
}

void adcgs_exposure_allow_burnt(const adcgs_exposure *e, uint32_t view, const float *drawn, const float background[3],
                                float *target, size_t plane)
{
    const float full[3] = {ADCGS_BURNT, ADCGS_BURNT, ADCGS_BURNT};
    float burnt[3], backdrop[3] = {0, 0, 0};
    adcgs_exposure_even(e, view, full, burnt, 1);
    if (background)
        adcgs_exposure_even(e, view, background, backdrop, 1);
    for (size_t i = 0; i < plane; i++) {
        if (background && is_backdrop(target + i, plane, backdrop))
            continue;
        for (size_t c = 0; c < 3; c++)
            if (target[c * plane + i] >= burnt[c])
                target[c * plane + i] = fmaxf(target[c * plane + i], drawn[c * plane + i]);
    }
}
