/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Selection of a scene's frames. */
#include "config.h"

#include "scene/frames.h"

#include "scene/scene.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdlib.h>

#define FRAME_MAX 1000000000 /* larger frame numbers are mistakes; chosen by hand, not measured */
/* Largest distance of a time from its grid point, as a share of an interval; chosen by hand, not measured. */
#define GRID_WITHIN 0.25

/** Reads digits, if there are any. Returns 0, or -1 if the number is too large. */
static int take_number(const char **text, int64_t *value)
{
    if (**text < '0' || **text > '9')
        return 0;
    for (*value = 0; **text >= '0' && **text <= '9'; (*text)++) {
        *value = 10 * *value + (**text - '0');
        if (*value > FRAME_MAX)
            return -1;
    }
    return 0;
}

adcgs_status adcgs_frames_parse(adcgs_frame_range *range, const char *text, adcgs_error *error)
{
    adcgs_frame_range r = {.end = -1, .step = 1};
    const char *at = text;
    int bad = take_number(&at, &r.begin) || *at++ != ':';
    bad = bad || take_number(&at, &r.end);
    if (!bad && *at == ':') {
        at++;
        bad = take_number(&at, &r.step);
    }
    if (bad || *at || !r.step)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--frames %.64s: expected A:B or A:B:STEP, with STEP at least 1", text);
    if (r.end >= 0 && r.end <= r.begin)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "--frames %.64s: holds no frame, %lld is not below %lld", text,
                          (long long)r.begin, (long long)r.end);
    r.end = ADCGS_MAX(r.end, 0);
    *range = r;
    return ADCGS_OK;
}

int64_t adcgs_frames_step(const adcgs_frame_range *range)
{
    return ADCGS_MAX(range->step, 1);
}

adcgs_status adcgs_frames_count(const adcgs_frame_range *range, int64_t n, int64_t *count, const char *path, adcgs_error *error)
{
    const int64_t end = range->end && range->end < n ? range->end : n, step = adcgs_frames_step(range);
    *count = range->begin < end ? (end - range->begin + step - 1) / step : 0;
    if (!*count)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: --frames begins with frame %lld, but there are %lld, counted from 0", path,
                          (long long)range->begin, (long long)n);
    return ADCGS_OK;
}

/** Removes repeated values from ascending values; returns the number of distinct ones. */
static size_t drop_repeated(double *values, size_t n)
{
    size_t kept = ADCGS_MIN(n, 1);
    for (size_t i = 1; i < n; i++)
        if (values[i] - values[kept - 1] > ADCGS_TIME_TOLERANCE)
            values[kept++] = values[i];
    return kept;
}

/** The distinct times of the views of the first `splits` splits, ascending, from malloc(). */
static double *find_times(const adcgs_scene *scene, int splits, size_t *n)
{
    size_t all = 0;
    for (int s = 0; s < splits; s++)
        all += scene->n_views[s];
    double *times = malloc((all + 1) * sizeof *times);
    if (!times)
        return NULL;
    all = 0;
    for (int s = 0; s < splits; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++)
            times[all++] = scene->views[s][i].time;
    adcgs_sort(times, all);
    *n = drop_repeated(times, all);
    return times;
}

/** Index of a time among the distinct times. */
static int64_t find_time(const double *times, size_t n, double time)
{
    size_t low = 0, high = n;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (times[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return (int64_t)low;
}

static void keep_views(adcgs_scene *scene, int split, const adcgs_frame_range *range, int64_t count, const double *times,
                       size_t n)
{
    const int64_t step = adcgs_frames_step(range), last = range->begin + (count - 1) * step;
    const double first = times[range->begin], span = times[last] - first;
    adcgs_scene_view *views = scene->views[split];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->n_views[split]; i++) {
        const int64_t at = find_time(times, n, views[i].time);
        if (at < range->begin || at > last || (at - range->begin) % step) {
            adcgs_scene_view_clear(&views[i]);
            continue;
        }
        views[kept] = views[i];
        views[kept++].time = span > 0.0 ? (times[at] - first) / span : 0.0;
    }
    scene->n_views[split] = kept;
}

adcgs_status adcgs_frames_keep(adcgs_scene *scene, const adcgs_frame_range *range, const char *path, adcgs_error *error)
{
    size_t n = 0;
    int64_t count;
    if (!range->begin && !range->end && adcgs_frames_step(range) == 1)
        return ADCGS_OK;
    double *times = find_times(scene, ADCGS_SPLITS, &n);
    if (!times)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    const adcgs_status status = adcgs_frames_count(range, (int64_t)n, &count, path, error);
    for (int s = 0; status == ADCGS_OK && s < ADCGS_SPLITS; s++)
        keep_views(scene, s, range, count, times, n);
    if (status == ADCGS_OK)
        scene->intervals *= times[range->begin + (count - 1) * adcgs_frames_step(range)] - times[range->begin];
    free(times);
    ADCGS_TRY(status);
    if (!scene->n_views[ADCGS_SPLIT_TRAIN])
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: --frames leaves no view for training", path);
    return ADCGS_OK;
}

/* ---- Number of intervals ---- */

/** True if all times are multiples of 1/intervals, to within the precision of files with six digits. */
static int is_grid(const double *times, size_t n, double intervals)
{
    const double within = fmin(ADCGS_TIME_TOLERANCE * intervals, GRID_WITHIN);
    for (size_t i = 0; i < n; i++)
        if (!(fabs(times[i] * intervals - rint(times[i] * intervals)) <= within))
            return 0;
    return 1;
}

/** The coarsest grid of which the times fill at least half; 0 if there is none. */
static double find_grid(const double *times, size_t n)
{
    for (size_t intervals = n - 1; intervals && intervals <= 2 * (n - 1); intervals++)
        if (is_grid(times, n, (double)intervals))
            return (double)intervals;
    return 0.0;
}

adcgs_status adcgs_frames_intervals(const adcgs_scene *scene, uint32_t *n_times, double *intervals, const char *path,
                                    adcgs_error *error)
{
    size_t n_all = 0, n = 0;
    double *all = find_times(scene, ADCGS_SPLITS, &n_all), *train = find_times(scene, ADCGS_SPLIT_TRAIN + 1, &n);
    const adcgs_status status = all && train ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (status == ADCGS_OK) {
        const double own = find_grid(train, n), common = n > 1 ? find_grid(all, n_all) : 0.0;
        *n_times = (uint32_t)n;
        *intervals = (double)(n - 1);
        if (own > *intervals) /* the training views leave gaps */
            *intervals = common > 0.0 ? common : own;
        else if (!(own > 0.0) && common > 0.0)
            *intervals = common;
    }
    free(all);
    free(train);
    return status;
}
