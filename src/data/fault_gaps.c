/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Times at which cameras that take pictures regularly have none. */
#include "config.h"

#include "data/faults.h"

#include "data/by_camera.h"
#include "data/sort.h"

#include <math.h>

#define STEPS 2.5   /* median steps that are a gap: one picture that is put aside makes two */
#define REGULAR 0.6 /* of a camera's steps that are the median, within a half: where times are random fewer are, some 0.4 */
#define FEW 6       /* pictures of which nothing can be said */

/**
 * The median of the steps between n ascending times that differ; 0 where it is not regular, or where they are few. *median: in
 * any case, 0 where there is none.
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

/** Room for what follows: [n] each. */
typedef struct space {
    double *times, *steps;
    double *aside; /* times at which others than training's views were taken by a camera that moves, in any order */
    uint32_t n_aside;
} space;

/** At least half of what is missing was put aside, not lost. */
static int is_filled(const space *s, double from, double to, double step)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->n_aside; i++)
        count += s->aside[i] > from && s->aside[i] < to;
    return 2.0 * count >= (to - from) / step - 1.5;
}

/** The widest gap between s->times; *count: how many there are. */
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

/** *least_step: the least of the cameras' median steps. */
static void look_at_cameras(adcgs_fault *f, const adcgs_scene_view *views, const adcgs_tracks *tracks, space *s,
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
 * Of all cameras at once. Where these take turns a moment of the scene is shorter than the step of a camera; where their clocks
 * are not tied together steps of the scene are of any length, but none is longer than those of a camera.
 */
static void look_at_moments(adcgs_fault *f, const adcgs_scene_view *views, uint32_t n, uint32_t cameras, space *s,
                            double least_step)
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
    *f = (adcgs_fault){.cameras = cameras, .of = cameras, .count = count, .from = s->times[at - 1], .to = s->times[at],
                       .size = round(gap / step) - 1.0};
}

/** Whether one of the cameras took a view. */
static int is_known(const adcgs_scene_view *views, const adcgs_tracks *tracks, const adcgs_scene_view *view)
{
    int known = 0;
    for (uint32_t c = 0; c < tracks->n && !known; c++)
        known = !adcgs_camera_compare(&views[tracks->order[tracks->begin[c]]].camera, &view->camera);
    return known;
}

/**
 * Training's views, then those of other splits that training's cameras took; *views: room for all. Of a camera that moves it is
 * not known which of the others it took.
 */
static adcgs_status gather(const adcgs_scene *scene, adcgs_scene_view *views, uint32_t *n, space *s, adcgs_error *error)
{
    adcgs_tracks tracks;
    *n = scene->n_views[ADCGS_SPLIT_TRAIN];
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], *n * sizeof *views);
    ADCGS_TRY(adcgs_tracks_find(&tracks, views, *n, error));
    for (int split = ADCGS_SPLIT_TRAIN + 1; split < ADCGS_SPLITS; split++)
        for (uint32_t i = 0; i < scene->n_views[split]; i++)
            if (tracks.moves)
                s->aside[s->n_aside++] = scene->views[split][i].time;
            else if (is_known(views, &tracks, &scene->views[split][i]))
                views[(*n)++] = scene->views[split][i];
    adcgs_tracks_clear(&tracks);
    return ADCGS_OK;
}

static adcgs_status look(adcgs_fault *f, const adcgs_scene *scene, adcgs_scene_view *views, space *s, adcgs_error *error)
{
    adcgs_tracks tracks;
    uint32_t n;
    double least_step = HUGE_VAL;
    ADCGS_TRY(gather(scene, views, &n, s, error));
    ADCGS_TRY(adcgs_tracks_find(&tracks, views, n, error));
    look_at_cameras(f, views, &tracks, s, &least_step);
    if (tracks.n > 1)
        look_at_moments(f, views, n, tracks.n, s, least_step);
    adcgs_tracks_clear(&tracks);
    return ADCGS_OK;
}

adcgs_status adcgs_fault_gaps(adcgs_fault *fault, const adcgs_scene *scene, adcgs_error *error)
{
    size_t most = 1;
    for (int split = 0; split < ADCGS_SPLITS; split++)
        most += scene->n_views[split];
    adcgs_scene_view *const views = adcgs_alloc(NULL, most, sizeof *views, error);
    space s = {.times = adcgs_alloc(NULL, most, sizeof *s.times, error), .steps = adcgs_alloc(NULL, most, sizeof *s.steps, error),
               .aside = adcgs_alloc(NULL, most, sizeof *s.aside, error)};
    *fault = (adcgs_fault){.cameras = 0};
    const int has_room = views && s.times && s.steps && s.aside;
    const adcgs_status status = has_room ? look(fault, scene, views, &s, error) : adcgs_alloc_status(error);
    adcgs_free(NULL, views);
    adcgs_free(NULL, s.times);
    adcgs_free(NULL, s.steps);
    adcgs_free(NULL, s.aside);
    return status;
}
