/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Choice of the cameras that a stream stores. */
#include "config.h"

#include "encode/stored_cameras.h"

#include "encode/filmed_path.h"
#include "scene/camera_order.h"
#include "scene/group_views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Length of a path without extension and the number before it: equal for the images of one camera. */
static size_t stem_of_camera(const adcgs_scene_view *v)
{
    const char *const dot = strrchr(v->path, '.');
    size_t n = !v->is_video && dot && !strchr(dot, '/') ? (size_t)(dot - v->path) : strlen(v->path);
    while (!v->is_video && n > 0 && v->path[n - 1] >= '0' && v->path[n - 1] <= '9')
        n--;
    return n;
}

static int compare_cameras(const adcgs_scene_view *a, const adcgs_scene_view *b)
{
    const size_t m = stem_of_camera(a), n = stem_of_camera(b);
    const int order = memcmp(a->path, b->path, ADCGS_MIN(m, n));
    return order ? order : (m > n) - (m < n);
}

static int by_camera_and_time(const void *a, const void *b)
{
    const adcgs_scene_view *const x = a, *const y = b;
    const int order = compare_cameras(x, y);
    return order ? order : (x->time > y->time) - (x->time < y->time);
}

/** Adds a path's keys. The name stands in the first one. */
static void add_path(adcgs_stream *s, const adcgs_filmed_path *path, int number)
{
    for (int i = 0; i < path->n; i++) {
        adcgs_stored_camera *const to = &s->cameras[s->n_cameras++];
        *to = (adcgs_stored_camera){.camera = path->keys[i].frame.camera, .time = path->keys[i].at, .path = number};
        if (i)
            memset(to->camera.name, 0, sizeof to->camera.name);
    }
}

/** Adds a camera, unless one like it is stored already. */
static void add_camera(adcgs_stream *s, const adcgs_scene *scene, const adcgs_scene_view *view)
{
    const adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    uint32_t views_of_it = 0;
    for (uint32_t i = 0; i < s->n_cameras; i++)
        if (s->cameras[i].path < 0 && !adcgs_camera_compare(&s->cameras[i].camera, &view->camera))
            return;
    for (uint32_t i = 0; i < n && views_of_it < 2; i++)
        views_of_it += !adcgs_camera_compare(&views[i].camera, &view->camera);
    s->cameras[s->n_cameras++] = (adcgs_stored_camera){.camera = view->camera,
                                                       .time = views_of_it == 1 && scene->duration > 0 ? view->time : (double)NAN,
                                                       .path = -1};
}

/** The filmed paths of the scene. views: the training views, sorted by camera and time. */
static adcgs_status find_paths(adcgs_filmed_path paths[ADCGS_STORED_PATHS_MAX], const adcgs_scene_view *views, uint32_t n,
                               double scale, adcgs_error *error)
{
    int found = 0;
    for (uint32_t begin = 0, end; begin < n && found < ADCGS_STORED_PATHS_MAX; begin = end) {
        adcgs_camera_order order;
        for (end = begin + 1; end < n && !compare_cameras(&views[begin], &views[end]); end++)
            ;
        ADCGS_TRY(adcgs_camera_order_find(&order, &views[begin], end - begin, error));
        adcgs_status status = ADCGS_OK;
        if (order.moves)
            status = adcgs_filmed_path_make(&paths[found], &views[begin], end - begin, scale, error);
        adcgs_camera_order_clear(&order);
        if (status != ADCGS_OK)
            return status;
        found += paths[found].n > 0;
    }
    return ADCGS_OK;
}

/** views: the training views, sorted by camera and time. */
static adcgs_status store(adcgs_stream *s, const adcgs_scene *scene, const adcgs_filmed_path *paths,
                          const adcgs_scene_view *views, adcgs_error *error)
{
    size_t n = ADCGS_STORED_CAMERAS_MAX;
    int is_path = 0;
    for (int i = 0; i < ADCGS_STORED_PATHS_MAX; i++)
        n += (size_t)paths[i].n;
    s->cameras = adcgs_alloc(NULL, n, sizeof *s->cameras, error);
    if (!s->cameras)
        return adcgs_alloc_status(error);
    for (int i = 0; i < ADCGS_STORED_PATHS_MAX; i++)
        if (paths[i].n)
            add_path(s, &paths[i], is_path++);
    const uint32_t all = scene->n_views[ADCGS_SPLIT_TRAIN];
    for (uint32_t i = 0; !is_path && i < ADCGS_STORED_CAMERAS_MAX; i++)
        add_camera(s, scene, &views[(uint64_t)i * all / ADCGS_STORED_CAMERAS_MAX]);
    return ADCGS_OK;
}

adcgs_status adcgs_stored_cameras_choose(adcgs_stream *stream, const adcgs_scene *scene, adcgs_error *error)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_filmed_path paths[ADCGS_STORED_PATHS_MAX] = {{.n = 0}};
    adcgs_scene_view *const views = adcgs_alloc(NULL, n, sizeof *views, error);
    if (!views)
        return adcgs_alloc_status(error);
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], n * sizeof *views);
    qsort(views, n, sizeof *views, by_camera_and_time);
    adcgs_status status = ADCGS_OK;
    if (scene->duration > 0)
        status = find_paths(paths, views, n, stream->scene_scale, error);
    if (status == ADCGS_OK)
        status = store(stream, scene, paths, views, error);
    for (int i = 0; i < ADCGS_STORED_PATHS_MAX; i++)
        adcgs_filmed_path_clear(&paths[i]);
    adcgs_free(NULL, views);
    return status;
}
