/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parts of a scene in time. */
#include "scene/part.h"

#include "scene/clips.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdlib.h>

/** Lists the n distinct times of the training views, ascending. */
static adcgs_status list_times(double **out, uint32_t *n, const adcgs_scene *scene, adcgs_error *error)
{
    const uint32_t views = scene->n_views[ADCGS_SPLIT_TRAIN];
    double *times = adcgs_alloc(NULL, views, sizeof *times, error);
    *out = times;
    *n = 0;
    if (!times)
        return adcgs_alloc_status(error);
    for (uint32_t i = 0; i < views; i++)
        times[i] = fmin(fmax(scene->views[ADCGS_SPLIT_TRAIN][i].time, 0), scene->duration);
    adcgs_sort(times, views);
    for (uint32_t i = 0; i < views; i++)
        if (!i || times[i] - times[*n - 1] > ADCGS_TIME_TOLERANCE * scene->duration)
            times[(*n)++] = times[i];
    return ADCGS_OK;
}

/** Index of the list's time nearest to a given time. */
static uint32_t nearest(const double *times, uint32_t n, double time)
{
    uint32_t best = 0;
    for (uint32_t i = 1; i < n; i++)
        if (fabs(times[i] - time) < fabs(times[best] - time))
            best = i;
    return best;
}

static void cut(adcgs_cuts *cuts, const double *times, uint32_t n, double duration, double seconds)
{
    uint32_t last = 0;
    cuts->at[0] = 0;
    cuts->moments = n;
    for (double time = seconds; time + seconds / 2 <= duration; time += seconds) {
        const uint32_t i = nearest(times, n, time);
        if (i <= last || i + 1 >= n)
            continue;
        cuts->at[++cuts->n] = times[i];
        cuts->moments = ADCGS_MIN(cuts->moments, i - last + 1);
        last = i;
    }
    cuts->at[++cuts->n] = duration;
    cuts->moments = ADCGS_MIN(cuts->moments, n - last);
}

/** Extends parts past their ends, up to the last frame within the limits. */
static void reach_out(adcgs_cuts *cuts, const double *times, uint32_t n, double duration, double fade)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i + 1 < cuts->n; i++) {
        const double *at = cuts->at + i, shorter = fmin(at[1] - at[0], at[2] - at[1]);
        const double until = at[1] + fmin(fade, shorter / 4) + ADCGS_TIME_TOLERANCE * duration;
        while (next < n && times[next] <= until)
            next++;
        cuts->reach[i] = times[next - 1] - at[1]; /* next > 0, since the cut itself is a frame */
    }
}

adcgs_status adcgs_cuts_find(adcgs_cuts *cuts, const adcgs_scene *scene, double seconds, double fade, adcgs_error *error)
{
    double *times;
    uint32_t n;
    adcgs_status status = list_times(&times, &n, scene, error);
    if (status == ADCGS_OK && n < 2)
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: only one distinct time: there is nothing to cut", scene->directory);
    if (status == ADCGS_OK) {
        cuts->at = adcgs_alloc(NULL, n + 1, sizeof *cuts->at, error);
        cuts->reach = adcgs_alloc(NULL, n, sizeof *cuts->reach, error);
        status = cuts->at && cuts->reach ? ADCGS_OK : adcgs_alloc_status(error);
    }
    if (status == ADCGS_OK) {
        cut(cuts, times, n, scene->duration, fmax(seconds, scene->duration / n));
        reach_out(cuts, times, n, scene->duration, fade);
    }
    adcgs_free(NULL, times);
    return status;
}

void adcgs_cuts_clear(adcgs_cuts *cuts)
{
    adcgs_free(NULL, cuts->at);
    adcgs_free(NULL, cuts->reach);
    *cuts = (adcgs_cuts){.n = 0};
}

/** Copies the training views from begin to end, with times relative to begin. */
static void take_views(adcgs_scene *part, const adcgs_scene *whole, double begin, double end)
{
    const double within = ADCGS_TIME_TOLERANCE * whole->duration;
    uint32_t n = 0;
    for (uint32_t i = 0; i < whole->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        const adcgs_scene_view *v = &whole->views[ADCGS_SPLIT_TRAIN][i];
        const double time = fmin(fmax(v->time, 0), whole->duration);
        if (time < begin - within || time > end + within)
            continue;
        part->views[ADCGS_SPLIT_TRAIN][n] = *v;
        part->views[ADCGS_SPLIT_TRAIN][n++].time = fmin(fmax(time - begin, 0), end - begin);
    }
    part->n_views[ADCGS_SPLIT_TRAIN] = n;
}

adcgs_status adcgs_scene_part(adcgs_scene *part, const adcgs_scene *whole, const adcgs_cuts *cuts, uint32_t index,
                              adcgs_error *error)
{
    const double begin = cuts->at[index], end = cuts->at[index + 1] + (cuts->reach ? cuts->reach[index] : 0);
    double *times;
    *part = *whole;
    part->whole = whole;
    part->duration = end - begin;
    memset(part->views, 0, sizeof part->views);
    memset(part->n_views, 0, sizeof part->n_views);
    part->views[ADCGS_SPLIT_TRAIN] = adcgs_alloc(NULL, whole->n_views[ADCGS_SPLIT_TRAIN], sizeof *part->views[0], error);
    if (!part->views[ADCGS_SPLIT_TRAIN])
        return adcgs_alloc_status(error);
    take_views(part, whole, begin, end);
    const adcgs_status status = list_times(&times, &part->n_times, part, error);
    adcgs_free(NULL, times);
    if (status != ADCGS_OK)
        adcgs_scene_part_clear(part);
    return status;
}

void adcgs_scene_part_clear(adcgs_scene *part)
{
    adcgs_free(NULL, part->views[ADCGS_SPLIT_TRAIN]);
    *part = (adcgs_scene){.n_times = 0};
}

adcgs_status adcgs_scene_part_create(adcgs_scene **out, const adcgs_scene *whole, adcgs_error *error)
{
    adcgs_scene *part = *out = calloc(1, sizeof *part);
    if (!part)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", whole->directory);
    *part = *whole;
    part->whole = whole;
    part->clips = NULL;
    memset(part->views, 0, sizeof part->views);
    memset(part->n_views, 0, sizeof part->n_views);
    return adcgs_clips_create(&part->clips, error);
}

void adcgs_scene_part_free(adcgs_scene **part)
{
    adcgs_scene *p = *part;
    if (!p)
        return;
    for (int s = 0; s < ADCGS_SPLITS; s++) {
        for (uint32_t i = 0; i < p->n_views[s]; i++)
            adcgs_scene_view_clear(&p->views[s][i]);
        free(p->views[s]);
    }
    adcgs_clips_free(&p->clips);
    free(p);
    *part = NULL;
}

adcgs_status adcgs_scene_part_count_times(adcgs_scene *part, adcgs_error *error)
{
    double *times;
    part->n_times = 0;
    if (!part->n_views[ADCGS_SPLIT_TRAIN])
        return ADCGS_OK;
    const adcgs_status status = list_times(&times, &part->n_times, part, error);
    adcgs_free(NULL, times);
    return status;
}
