/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Training views held out from a trial. */
#include "train/trial/trial_scene.h"

#include "scene/group_views.h"
#include "scene/part.h"
#include "system/sort_values.h"
#include "train/scene_frame.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
enum {
    VIEWS_LEAST = 12,  /* minimum training views for trials */
    CAMERAS_LEAST = 5, /* minimum cameras to hold out whole cameras */
    IMAGES_LEAST = 4,  /* minimum mean images per camera to hold out whole cameras */
    ONE_IN = 8         /* one camera, or one image, of so many is held out */
};

/** Finds the interval around the middle of time with at most ADCGS_TRIAL_VIEWS training views. */
static adcgs_status find_stretch(const adcgs_scene *scene, double *begin, double *end, adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    *begin = 0;
    *end = scene->duration;
    if (n <= ADCGS_TRIAL_VIEWS || scene->n_times <= 1)
        return ADCGS_OK;
    double *time = adcgs_alloc(NULL, n, sizeof *time, error);
    if (!time)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < n; i++)
        time[i] = fmin(fmax(scene->views[ADCGS_SPLIT_TRAIN][i].time, 0), scene->duration);
    adcgs_sort(time, n);
    *begin = time[n / 2 - ADCGS_TRIAL_VIEWS / 2];
    *end = time[n / 2 + ADCGS_TRIAL_VIEWS / 2 - 1];
    adcgs_free(NULL, time);
    return ADCGS_OK;
}

/** Copies the training views of an interval, with times relative to its start. */
static void take_stretch(adcgs_scene *to, const adcgs_scene *scene, double begin, double end)
{
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN];
    /* A static scene with many images has no interval and is thinned instead. */
    const uint32_t step = scene->n_times <= 1 ? (all + ADCGS_TRIAL_VIEWS - 1) / ADCGS_TRIAL_VIEWS : 1;
    uint32_t n = 0;
    for (uint32_t i = 0; i < all; i += step) {
        const adcgs_scene_view *v = &scene->views[ADCGS_SPLIT_TRAIN][i];
        const double time = fmin(fmax(v->time, 0), scene->duration);
        if (time < begin || time > end)
            continue;
        to->views[ADCGS_SPLIT_TRAIN][n] = *v;
        to->views[ADCGS_SPLIT_TRAIN][n++].time = time - begin;
    }
    to->n_views[ADCGS_SPLIT_TRAIN] = n;
    to->duration = end - begin;
}

/** True if number i of n is one of the n / ONE_IN held out: evenly spread, each in the middle of its neighbours. */
static int is_held(uint32_t i, uint32_t n)
{
    const uint64_t held = ADCGS_MAX(n / ONE_IN, 1), k = i * held / n;
    return i == (2 * k + 1) * n / (2 * held);
}

/** Moves held-out views to the other split, and thins them evenly to ADCGS_TRIAL_JUDGES. */
static void hold_back(adcgs_scene *s, const uint32_t *of, uint32_t cameras)
{
    const uint32_t n = s->n_views[ADCGS_SPLIT_TRAIN];
    const int whole = cameras >= CAMERAS_LEAST && n >= IMAGES_LEAST * cameras;
    uint32_t kept = 0, held = 0, judges = 0;
    for (uint32_t i = 0; i < n; i++) {
        const adcgs_scene_view v = s->views[ADCGS_SPLIT_TRAIN][i];
        if (whole ? is_held(of[i], cameras) : is_held(i, n))
            s->views[ADCGS_SPLIT_VAL][held++] = v;
        else
            s->views[ADCGS_SPLIT_TRAIN][kept++] = v;
    }
    for (uint32_t i = 0; i < held; i++)
        if ((uint64_t)i * ADCGS_TRIAL_JUDGES / held >= judges)
            s->views[ADCGS_SPLIT_VAL][judges++] = s->views[ADCGS_SPLIT_VAL][i];
    s->n_views[ADCGS_SPLIT_TRAIN] = kept;
    s->n_views[ADCGS_SPLIT_VAL] = judges;
}

static adcgs_status split(adcgs_scene *s, adcgs_error *error)
{
    const uint32_t n = s->n_views[ADCGS_SPLIT_TRAIN];
    uint32_t cameras = 0, *of = adcgs_alloc(NULL, n, sizeof *of, error);
    if (!of)
        return adcgs_alloc_status(error);
    const adcgs_status status = adcgs_group_views(s->views[ADCGS_SPLIT_TRAIN], n, of, NULL, &cameras, error);
    if (status == ADCGS_OK)
        hold_back(s, of, cameras);
    adcgs_free(NULL, of);
    return status == ADCGS_OK ? adcgs_scene_part_count_times(s, error) : status;
}

adcgs_status adcgs_trial_scene_make(adcgs_trial_scene *out, const adcgs_scene *scene, adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_scene *const s = &out->scene;
    double begin, end;
    *s = *scene;
    memset(s->views, 0, sizeof s->views);
    memset(s->n_views, 0, sizeof s->n_views);
    if (n < VIEWS_LEAST)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_scene_frame(scene, s->origin, &s->scale, error)); /* units do not depend on held-out views */
    ADCGS_TRY(find_stretch(scene, &begin, &end, error));
    s->views[ADCGS_SPLIT_TRAIN] = adcgs_alloc(NULL, n, sizeof *s->views[0], error);
    s->views[ADCGS_SPLIT_VAL] = adcgs_alloc(NULL, n, sizeof *s->views[0], error);
    adcgs_status status = s->views[ADCGS_SPLIT_TRAIN] && s->views[ADCGS_SPLIT_VAL] ? ADCGS_OK : adcgs_alloc_status(error);
    if (status == ADCGS_OK) {
        take_stretch(s, scene, begin, end);
        status = split(s, error);
    }
    if (status != ADCGS_OK)
        adcgs_trial_scene_clear(out);
    return status;
}

void adcgs_trial_scene_clear(adcgs_trial_scene *t)
{
    adcgs_free(NULL, t->scene.views[ADCGS_SPLIT_TRAIN]);
    adcgs_free(NULL, t->scene.views[ADCGS_SPLIT_VAL]);
    memset(&t->scene, 0, sizeof t->scene);
}
