/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Gaps in time of cameras that otherwise take images regularly. */
#include "config.h"

#include "check/faults.h"

#include "scene/group_views.h"
#include "system/sort_values.h"

#include <math.h>

/*
 * Origin: chosen by hand, and checked on 46 generated scenes and six others without faults, and on faults of known strength
 * (doc/log/stability.md, "Warnings about footage").
 */
#define STEPS 2.5   /* least gap in median steps: one held-out image makes a step of two */
#define REGULAR 0.6 /* least share of a camera's steps within half of the median; at random times about 0.4 are */
#define FEW 6       /* least number of images; fewer are not judged */

/**
 * Returns the median step between n ascending times, without steps of 0; 0 if the steps are irregular or too few. *median: the
 * median in any case, 0 without steps.
 */
static double regular_step(const double *times, uint32_t n, double *steps, double *median)
{
    uint32_t count = 0, near = 0;
    for (uint32_t i = 1; i < n; i++)
        if (times[i] - times[i - 1] > 0.0)
            steps[count++] = times[i] - times[i - 1];
    adcgs_sort(steps, count);
    *median = count ? steps[count / 2] : 0.0;
    for (uint32_t i = 0; i < count; i++)
        near += steps[i] > 0.5 * *median && steps[i] < 1.5 * *median;
    return count + 1 >= FEW && near >= REGULAR * count ? *median : 0.0;
}

/** Buffers: [n] each. */
typedef struct space {
    double *times, *steps;
    double *aside; /* times of held-out views (validation, test) of a moving camera, in any order */
    uint32_t n_aside;
} space;

/** True if at least half of the missing images were held out, not lost. */
static int is_filled(const space *s, double from, double to, double step)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->n_aside; i++)
        count += s->aside[i] > from && s->aside[i] < to;
    return 2.0 * count >= (to - from) / step - 1.5;
}

/** Returns the widest gap in s->times; *count: number of gaps. */
static double widest(const space *s, uint32_t n, double step_of, double least, uint32_t *count, uint32_t *at)
{
    double most = 0.0;
    *count = 0;
    for (uint32_t i = 1; i < n; i++) {
        const double step = s->times[i] - s->times[i - 1];
        if (!(step > least) || is_filled(s, s->times[i - 1], s->times[i], step_of))
            continue;
        ++*count;
        if (step > most) {
            most = step;
            *at = i;
        }
    }
    return most;
}

/** Lowers *least_step to the smallest of the cameras' median steps. */
static void look_at_cameras(adcgs_fault *f, const adcgs_scene_view *views, const adcgs_camera_order *tracks, space *s,
                            double *least_step)
{
    double worst = 0.0, median;
    for (uint32_t c = 0; c < tracks->n; c++) {
        const uint32_t *const order = tracks->order + tracks->begin[c], n = tracks->begin[c + 1] - tracks->begin[c];
        uint32_t count, at = 0;
        for (uint32_t i = 0; i < n; i++)
            s->times[i] = views[order[i]].time;
        const double step = regular_step(s->times, n, s->steps, &median);
        if (median > 0.0)
            *least_step = fmin(*least_step, median);
        if (!(step > 0.0))
            continue;
        f->of++;
        const double gap = widest(s, n, step, STEPS * step, &count, &at);
        f->cameras += count > 0;
        if (gap / step > worst) {
            worst = gap / step;
            f->path = views[order[at - 1]].path;
            f->from = s->times[at - 1];
            f->to = s->times[at];
            f->size = round(worst) - 1.0;
            f->count = count;
        }
    }
}

/**
 * Looks for gaps of all cameras together. Where cameras take turns, the scene's step is shorter than a camera's step. With
 * unsynchronised clocks the scene's steps have any length, but none exceeds a camera's steps.
 */
static void check_times(adcgs_fault *f, const adcgs_scene_view *views, uint32_t n, uint32_t cameras, space *s, double least_step)
{
    uint32_t count, at = 0;
    double median;
    for (uint32_t i = 0; i < n; i++)
        s->times[i] = views[i].time;
    adcgs_sort(s->times, n);
    const double step = regular_step(s->times, n, s->steps, &median);
    if (!(step > 0.0))
        return;
    const double gap = widest(s, n, step, fmax(STEPS * step, 1.5 * least_step), &count, &at);
    if (!count)
        return;
    *f = (adcgs_fault){.cameras = cameras,
                       .of = cameras,
                       .count = count,
                       .from = s->times[at - 1],
                       .to = s->times[at],
                       .size = round(gap / step) - 1.0};
}

/** True if one of the cameras took the view. */
static int is_known(const adcgs_scene_view *views, const adcgs_camera_order *tracks, const adcgs_scene_view *view)
{
    int known = 0;
    for (uint32_t c = 0; c < tracks->n && !known; c++)
        known = !adcgs_camera_compare(&views[tracks->order[tracks->begin[c]]].camera, &view->camera);
    return known;
}

/**
 * Collects the training views, then the views of other splits that training cameras took; *views has room for all. For a moving
 * camera it is unknown which of the other views it took.
 */
static adcgs_status gather(const adcgs_scene *scene, adcgs_scene_view *views, uint32_t *n, space *s, adcgs_error *error)
{
    adcgs_camera_order tracks;
    *n = scene->n_views[ADCGS_SPLIT_TRAIN];
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], *n * sizeof *views);
    ADCGS_TRY(adcgs_camera_order_find(&tracks, views, *n, error));
    for (int split = ADCGS_SPLIT_TRAIN + 1; split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split]; i++)
            if (tracks.moves)
                s->aside[s->n_aside++] = scene->views[split][i].time;
            else if (is_known(views, &tracks, &scene->views[split][i]))
                views[(*n)++] = scene->views[split][i];
    adcgs_camera_order_clear(&tracks);
    return ADCGS_OK;
}

static adcgs_status find_gaps(adcgs_fault *f, const adcgs_scene *scene, adcgs_scene_view *views, space *s, adcgs_error *error)
{
    adcgs_camera_order tracks;
    uint32_t n;
    double least_step = HUGE_VAL;
    ADCGS_TRY(gather(scene, views, &n, s, error));
    ADCGS_TRY(adcgs_camera_order_find(&tracks, views, n, error));
    look_at_cameras(f, views, &tracks, s, &least_step);
    if (tracks.n > 1)
        check_times(f, views, n, tracks.n, s, least_step);
    adcgs_camera_order_clear(&tracks);
    return ADCGS_OK;
}

adcgs_status adcgs_fault_gaps(adcgs_fault *fault, const adcgs_scene *scene, adcgs_error *error)
{
    size_t most = 1;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        most += scene->n_views[split];
    adcgs_scene_view *const views = adcgs_alloc(NULL, most, sizeof *views, error);
    space s = {.times = adcgs_alloc(NULL, most, sizeof *s.times, error),
               .steps = adcgs_alloc(NULL, most, sizeof *s.steps, error),
               .aside = adcgs_alloc(NULL, most, sizeof *s.aside, error)};
    *fault = (adcgs_fault){.cameras = 0};
    const int has_room = views && s.times && s.steps && s.aside;
    const adcgs_status status = has_room ? find_gaps(fault, scene, views, &s, error) : adcgs_alloc_status(error);
    adcgs_free(NULL, views);
    adcgs_free(NULL, s.times);
    adcgs_free(NULL, s.steps);
    adcgs_free(NULL, s.aside);
    return status;
}
