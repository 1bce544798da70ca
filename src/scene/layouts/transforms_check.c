/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Times, names and repeated frames of all views of transforms files. */
#include "config.h"

#include "scene/layouts/transforms_check.h"

#include "media/listing.h"
#include "scene/layouts/unmasked.h"
#include "scene/layouts/unposed.h"
#include "system/sort_values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define TIME_SLACK 1e-6 /* largest excess beyond 0 and 1, for rounding of binary32 times */
#define FPS_LEAST 1.0   /* frames per second: lowest rate that is suggested */
#define FPS_MOST 1000.0 /* frames per second: highest rate that is suggested */

typedef struct listed {
    const adcgs_scene_view *view;
    adcgs_split split;
} listed;

/** Lists all views of a scene, from malloc(); NULL on allocation failure. */
static listed *list_all(const adcgs_scene *scene, size_t *n)
{
    size_t all = 0;
    for (int s = 0; s < ADCGS_SPLITS; s++)
        all += scene->n_views[s];
    listed *list = calloc(all + 1, sizeof *list);
    *n = 0;
    for (int s = 0; list && s < ADCGS_SPLITS; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++)
            list[(*n)++] = (listed){&scene->views[s][i], (adcgs_split)s};
    return list;
}

static const char *short_path(const adcgs_scene *scene, const char *path)
{
    const size_t n = strlen(scene->directory);
    return strncmp(path, scene->directory, n) || path[n] != '/' ? path : path + n + 1;
}

/* ---- Times ---- */

/** Sorts values and returns the number of distinct ones. */
static size_t distinct(double *values, size_t n)
{
    size_t found = n > 0;
    adcgs_sort(values, n);
    for (size_t i = 1; i < n; i++)
        found += values[i] > values[i - 1];
    return found;
}

static void remark_scaled(adcgs_scene *scene, const adcgs_transforms *facts, double low, double high, size_t moments)
{
    const double fps = (double)(moments - 1) / (high - low), far = fmax(fabs(low), fabs(high));
    const int digits = (int)fmin(17.0, fmax(10.0, ceil(log10(far / (high - low)) + 4.0))); /* four digits of the range */
    char hint[80] = "";
    if (!facts->rate.den && moments > 1 && fps >= FPS_LEAST && fps <= FPS_MOST)
        snprintf(hint, sizeof hint, "; if these are seconds, give --fps %.4g", fps);
    adcgs_scene_remark(scene, "time ranges from %.*g to %.*g and is scaled to 0 to 1%s", digits, low, digits, high, hint);
}

static adcgs_status scale_times(adcgs_scene *scene, const adcgs_transforms *facts, const char *path, adcgs_error *error)
{
    double low = 0.0, high = 1.0, first = HUGE_VAL, last = -HUGE_VAL;
    size_t n;
    listed *list = list_all(scene, &n);
    double *times = malloc((n + 1) * sizeof *times);
    for (size_t i = 0; list && times && i < n; i++) {
        times[i] = list[i].view->time;
        first = fmin(first, times[i]);
        last = fmax(last, times[i]);
    }
    const int failed = !list || !times, is_scaled = !failed && (first < -TIME_SLACK || last > 1.0 + TIME_SLACK);
    if (is_scaled) {
        low = first;
        high = last > first ? last : first + 1.0;
        remark_scaled(scene, facts, low, high, distinct(times, n));
    }
    free(list);
    free(times);
    if (failed)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t i = 0; i < scene->n_views[s]; i++) {
            double *time = &scene->views[s][i].time;
            *time = is_scaled ? (*time - low) / (high - low) : fmin(fmax(*time, 0.0), 1.0);
        }
    return ADCGS_OK;
}

/** Orders by path, then by time. */
static int by_path(const void *a, const void *b)
{
    const adcgs_scene_view *x = ((const listed *)a)->view, *y = ((const listed *)b)->view;
    const int order = strcmp(x->path, y->path);
    return order ? order : (x->time > y->time) - (x->time < y->time);
}

/** True if names only count, like those of a video's frames. */
static int names_count(const listed *sorted, size_t n)
{
    adcgs_counting counting = {.n = 0};
    for (size_t i = 0; i < n; i++) {
        char stem[ADCGS_CAMERA_NAME_MAX + 1];
        adcgs_stem(stem, sizeof stem, sorted[i].view->path);
        adcgs_counting_add(&counting, stem);
    }
    return adcgs_counting_holds(&counting);
}

static void remark_times(adcgs_scene *scene, const adcgs_transforms *facts, int is_single, const listed *sorted, size_t n)
{
    if (facts->has_times)
        return;
    if (*facts->clock)
        adcgs_scene_remark(scene,
                           "frames have %s, which is not supported, and no time: the scene is treated as static; if "
                           "it moves, give each frame a time from 0 to 1",
                           facts->clock);
    else
        scene->counts = is_single && names_count(sorted, n);
}

/* ---- Repeated frames ---- */

/** Counts a frame in each split: the entries from `sorted` on with the same path and time. \return their number */
static size_t count_same(const listed *sorted, size_t n, size_t times[ADCGS_SPLITS])
{
    size_t same = 0;
    memset(times, 0, ADCGS_SPLITS * sizeof *times);
    while (same < n && !by_path(sorted, sorted + same))
        times[sorted[same++].split]++;
    return same;
}

/** sorted is by path and time. is_listed: the files list views for testing; otherwise the index of a frame decided. */
static adcgs_status find_twice(adcgs_scene *scene, const listed *sorted, size_t n, int is_listed, const char *path,
                               adcgs_error *error)
{
    size_t twice = 0, validated = 0, tested = 0, times[ADCGS_SPLITS];
    const char *first_twice = NULL, *first_validated = NULL;
    for (size_t i = 0, same; i < n; i += same) {
        const char *name = short_path(scene, sorted[i].view->path);
        same = count_same(sorted + i, n - i, times);
        tested += times[ADCGS_SPLIT_TRAIN] && times[ADCGS_SPLIT_TEST];
        if (is_listed && tested)
            return adcgs_fail(error, ADCGS_ERR_DATA,
                              "%s: %.100s is listed for training and for testing: a view for testing must "
                              "not be trained on; list it for one of them, or leave the list for testing out",
                              path, name);
        if (times[ADCGS_SPLIT_TRAIN] > 1 && !twice++)
            first_twice = name;
        if (times[ADCGS_SPLIT_TRAIN] && times[ADCGS_SPLIT_TEST] && !twice++)
            first_twice = name;
        if (times[ADCGS_SPLIT_TRAIN] && times[ADCGS_SPLIT_VAL] && !validated++)
            first_validated = name;
    }
    if (twice)
        adcgs_scene_remark(scene, "%zu frame%s for training come%s more than once, such as %.100s%s", twice, twice > 1 ? "s" : "",
                           twice > 1 ? "" : "s", first_twice,
                           tested ? ", also for testing: test figures do not "
                                    "measure new views"
                                  : "");
    if (validated)
        adcgs_scene_remark(scene,
                           "%zu frame%s for training, such as %.100s, %s listed for validation, too: validation "
                           "figures do not measure new views",
                           validated, validated > 1 ? "s" : "", first_validated, validated > 1 ? "are" : "is");
    return ADCGS_OK;
}

/* ---- Names ---- */

static int by_name(const void *a, const void *b)
{
    return strcmp(((const listed *)a)->view->camera.name, ((const listed *)b)->view->camera.name);
}

/** True if different files of a split have one name. list: room for all views. */
static int shares_names(const adcgs_scene *scene, int split, listed *list)
{
    const size_t n = scene->n_views[split];
    int found = 0;
    for (size_t i = 0; i < n; i++)
        list[i].view = &scene->views[split][i];
    if (n)
        qsort(list, n, sizeof *list, by_name);
    for (size_t i = 1; i < n && !found; i++)
        found = !strcmp(list[i].view->camera.name, list[i - 1].view->camera.name) &&
                strcmp(list[i].view->path, list[i - 1].view->path);
    return found;
}

/** Length of the path that all views share, up to a slash. sorted is by path. */
static size_t common_folders(const listed *sorted, size_t n)
{
    const char *first = sorted[0].view->path, *last = sorted[n - 1].view->path;
    size_t same = 0, folders = 0;
    for (; first[same] && first[same] == last[same]; same++)
        if (first[same] == '/')
            folders = same + 1;
    return folders;
}

/** Sets the name to the path without the common folders, or to the end of it if it is too long. */
static void set_name(adcgs_camera *camera, const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t n = dot && dot > (slash ? slash + 1 : path) ? (size_t)(dot - path) : strlen(path);
    if (n > ADCGS_CAMERA_NAME_MAX) {
        path += n - ADCGS_CAMERA_NAME_MAX;
        n = ADCGS_CAMERA_NAME_MAX;
    }
    snprintf(camera->name, sizeof camera->name, "%.*s", (int)n, path);
    for (char *c = camera->name; *c; c++)
        *c = *c == '/' ? '_' : *c;
}

/** Gives views distinct names. The order of the list is lost. */
static void name_apart(adcgs_scene *scene, listed *sorted, size_t n)
{
    const size_t common = n ? common_folders(sorted, n) : 0;
    const int all = shares_names(scene, ADCGS_SPLIT_TRAIN, sorted);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        if (all || shares_names(scene, s, sorted))
            for (uint32_t i = 0; i < scene->n_views[s]; i++)
                set_name(&scene->views[s][i].camera, scene->views[s][i].path + common);
}

/* ---- All ---- */

/** Reports images without a frame, if all frames lie in one folder for images. */
static adcgs_status remark_unposed(adcgs_scene *scene, const listed *sorted, size_t n, adcgs_error *error)
{
    const size_t common = common_folders(sorted, n), above = strlen(scene->directory) + 1;
    const char *folder = sorted[0].view->path;
    if (common <= above || strncmp(folder + above, "images", 6) != 0 || scene->is_outline)
        return ADCGS_OK;
    char *copy = strndup(folder, common);
    const adcgs_status status = copy ? adcgs_unposed_remark(scene, copy, error)
                                     : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", scene->directory);
    free(copy);
    return status;
}

adcgs_status adcgs_transforms_check(adcgs_scene *scene, const adcgs_transforms *facts, int is_single, const char *path,
                                    adcgs_error *error)
{
    size_t n;
    ADCGS_TRY(scale_times(scene, facts, path, error));
    listed *list = list_all(scene, &n);
    if (!list)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (n)
        qsort(list, n, sizeof *list, by_path);
    remark_times(scene, facts, is_single, list, n);
    adcgs_status status = find_twice(scene, list, n, !is_single || facts->has_lists, path, error);
    if (status == ADCGS_OK && n && is_single && !facts->has_lists)
        status = remark_unposed(scene, list, n, error);
    if (status == ADCGS_OK)
        status = adcgs_unmasked_remark(scene, "by mask_path", error);
    if (status == ADCGS_OK)
        name_apart(scene, list, n);
    free(list);
    return status;
}
