/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene whose footage arrives while it is recorded. */
#include "config.h"

#include "scene/live/live_scene.h"

#include "scene/live/live_watch.h"
#include "scene/part.h"
#include "system/paths.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define SCENE_NAME "scene.json"
#define END_NAME "end"

struct adcgs_live {
    adcgs_live_watch watch;
    const char *points_path;
    double origin[3], scale; /* of the stream to continue, else 0 */
    char *path;              /* of the scene file */
    adcgs_scene *whole;      /* opened with the first segment */
    uint8_t *told;           /* [n] nonzero for cameras whose missing images were reported */
};

/* ---- Segments ---- */

void adcgs_live_segment_clear(adcgs_live_segment *s)
{
    adcgs_scene_part_free(&s->scene);
    *s = (adcgs_live_segment){.scene = NULL};
}

/** Collects a camera's footage of the first given stretch, in the form that the scene file's reader takes. */
static adcgs_status gather(adcgs_live *l, uint32_t camera, uint32_t stretch, adcgs_footage *out, adcgs_error *error)
{
    const adcgs_live_camera *c = &l->watch.cameras[camera];
    const adcgs_live_limits limits = adcgs_live_limits_of(&l->watch, camera);
    int64_t span[2], n = 0;
    adcgs_live_frames(&l->watch, c, stretch, span);
    *out = (adcgs_footage){.width = c->width,
                           .height = c->height,
                           .rate = c->rate,
                           .frames = ADCGS_MAX(ADCGS_MIN(span[1], c->next) - span[0], 0)};
    for (int64_t i = 0; i < out->frames; i++)
        n += adcgs_live_camera_has(c, span[0] + i);
    if (n == 0)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: no footage arrived for the first segment", c->source->name);
    if (c->source->video) {
        out->video = adcgs_live_camera_path(c, 0, &limits, stretch);
        return out->video ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a segment");
    }
    out->pictures = calloc((size_t)out->frames, sizeof *out->pictures);
    for (int64_t i = 0; out->pictures && i < out->frames; i++)
        if (adcgs_live_camera_has(c, span[0] + i) && !(out->pictures[i] = adcgs_live_camera_path(c, span[0] + i, &limits, 0)))
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a segment");
    return out->pictures ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a segment");
}

/** Opens the scene with its first segment: positions of cameras, and size. */
static adcgs_status open_whole(adcgs_live *l, uint32_t stretch, adcgs_error *error)
{
    adcgs_footage *taken = calloc(l->watch.n, sizeof *taken);
    adcgs_status status = taken ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a segment");
    for (uint32_t i = 0; status == ADCGS_OK && i < l->watch.n; i++)
        status = gather(l, i, stretch, &taken[i], error);
    const adcgs_scene_options options = {.points_path = l->points_path, .dataset = ADCGS_DATASET_ADCGS, .taken = taken};
    if (status == ADCGS_OK)
        status = adcgs_scene_open(&l->whole, l->path, &options, error);
    for (uint32_t i = 0; taken && i < l->watch.n; i++)
        adcgs_footage_clear(&taken[i]);
    free(taken);
    if (status == ADCGS_OK) {
        memcpy(l->whole->origin, l->origin, sizeof l->origin);
        l->whole->scale = l->scale;
    }
    return status;
}

/** A view of the camera in the whole scene. */
static const adcgs_scene_view *find_view(const adcgs_live *l, uint32_t camera)
{
    const adcgs_scene_view *view = l->whole->views[ADCGS_SPLIT_TRAIN];
    while (strcmp(view->camera.name, l->watch.sources[camera].name) != 0)
        view++; /* each camera has one: gather() ensures it */
    return view;
}

/** Appends views of a camera to the segment's views. */
static adcgs_status add_views(adcgs_live *l, uint32_t camera, uint32_t stretch, adcgs_live_segment *s, adcgs_error *error)
{
    const adcgs_live_camera *c = &l->watch.cameras[camera];
    const adcgs_live_limits limits = adcgs_live_limits_of(&l->watch, camera);
    int64_t span[2];
    adcgs_live_frames(&l->watch, c, stretch, span);
    for (int64_t i = span[0]; i < span[1]; i++) {
        if (!adcgs_live_camera_has(c, i))
            continue;
        const double time = fmax(adcgs_live_camera_time(c, i), s->begin);
        const uint32_t file = adcgs_live_stretch(&l->watch, time);
        adcgs_scene_view view = *find_view(l, camera);
        view.time = time - s->begin;
        view.frame = c->source->video ? i - adcgs_live_first_of_file(&l->watch, c, file) : 0;
        view.path = adcgs_live_camera_path(c, i, &limits, file);
        view.mask = view.mask ? strdup(view.mask) : NULL;
        if (!view.path || (!view.mask && find_view(l, camera)->mask)) {
            adcgs_scene_view_clear(&view);
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a segment");
        }
        ADCGS_TRY(adcgs_scene_append(s->scene, ADCGS_SPLIT_TRAIN, &view, l->path, error));
    }
    return ADCGS_OK;
}

/** Ends a segment at its last view, if no footage follows it. */
static void find_end(const adcgs_live *l, adcgs_live_segment *s)
{
    s->end = fmin(s->end, l->watch.last);
    s->scene->duration = s->end - s->begin;
    for (uint32_t i = 0; i < s->scene->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        adcgs_scene_view *v = &s->scene->views[ADCGS_SPLIT_TRAIN][i];
        v->time = fmin(v->time, s->scene->duration);
    }
}

static adcgs_status make_segment(adcgs_live *l, uint32_t stretch, adcgs_live_segment *s, adcgs_error *error)
{
    *s = (adcgs_live_segment){.begin = adcgs_live_cut(&l->watch, stretch),
                              .end = adcgs_live_cut(&l->watch, stretch + 1),
                              .came = l->watch.came[stretch - l->watch.n_passed]};
    if (!l->whole)
        ADCGS_TRY(open_whole(l, stretch, error));
    ADCGS_TRY(adcgs_scene_part_create(&s->scene, l->whole, error));
    for (uint32_t i = 0; i < l->watch.n; i++)
        ADCGS_TRY(add_views(l, i, stretch, s, error));
    find_end(l, s);
    return adcgs_scene_part_count_times(s->scene, error);
}

/** Deletes data that no segment from this one on needs: frame records, and files of footage from pipes. */
static void forget(adcgs_live *l, uint32_t stretch)
{
    for (uint32_t i = 0; i < l->watch.n; i++) {
        const adcgs_live_limits limits = adcgs_live_limits_of(&l->watch, i);
        int64_t span[2];
        adcgs_live_frames(&l->watch, &l->watch.cameras[i], stretch, span);
        adcgs_live_camera_forget(&l->watch.cameras[i], span[0]);
        if (!l->watch.sources[i].video || stretch < 2)
            continue;
        char *path = adcgs_live_camera_path(&l->watch.cameras[i], 0, &limits, stretch - 2);
        if (path)
            unlink(path);
        free(path);
    }
}

static adcgs_status take_next(adcgs_live *l, adcgs_live_segment *s, adcgs_error *error)
{
    for (;;) {
        ADCGS_TRY(adcgs_live_await(&l->watch, error));
        if (l->watch.taken == l->watch.n_complete)
            return l->whole || l->watch.goes_on ? ADCGS_OK
                                                : adcgs_fail(error, ADCGS_ERR_DATA,
                                                             "%s: the footage ended with a single frame time, expected two or "
                                                             "more",
                                                             l->path);
        forget(l, l->watch.taken);
        ADCGS_TRY(make_segment(l, l->watch.taken++, s, error));
        if (s->scene->n_times > 1)
            return ADCGS_OK;
        adcgs_live_segment_clear(s);
    }
}

adcgs_status adcgs_live_next(adcgs_live *l, adcgs_live_segment *segment, adcgs_error *error)
{
    adcgs_live_segment_clear(segment);
    adcgs_live_lock(&l->watch);
    const adcgs_status status = take_next(l, segment, error);
    pthread_mutex_unlock(&l->watch.lock);
    return status;
}

const adcgs_scene *adcgs_live_whole(const adcgs_live *l)
{
    return l->whole;
}

const char *adcgs_live_missing(adcgs_live *l, double *time)
{
    const char *name = NULL;
    adcgs_live_lock(&l->watch);
    for (uint32_t i = 0; !name && i < l->watch.n; i++)
        if (l->watch.cameras[i].n_missing && !l->told[i]) {
            l->told[i] = 1;
            *time = adcgs_live_camera_time(&l->watch.cameras[i], l->watch.cameras[i].first_missing);
            name = l->watch.sources[i].name;
        }
    pthread_mutex_unlock(&l->watch.lock);
    return name;
}

uint32_t adcgs_live_times(const adcgs_live *l, double *at)
{
    for (uint32_t i = 0; at && i < l->watch.n; i++) {
        at[2 * i] = l->watch.cameras[i].offset;
        at[2 * i + 1] = adcgs_live_camera_time(&l->watch.cameras[i], 1);
    }
    return 2 * l->watch.n;
}

/* ---- Opening ---- */

static adcgs_status find_paths(adcgs_live *l, const char *path, adcgs_error *error)
{
    const char *const chosen = getenv("TMPDIR");
    l->path = adcgs_is_folder(path) ? adcgs_path("%s/" SCENE_NAME, path) : strdup(path);
    const char *const slash = l->path ? strrchr(l->path, '/') : NULL;
    l->watch.end_path = l->path ? adcgs_path("%.*s" END_NAME, slash ? (int)(slash - l->path + 1) : 0, l->path) : NULL;
    l->watch.folder = adcgs_path("%s/adcgs-live-XXXXXX", chosen && *chosen ? chosen : "/var/tmp");
    return l->path && l->watch.end_path && l->watch.folder ? ADCGS_OK
                                                           : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
}

static int has_videos(const adcgs_live *l)
{
    int some = 0;
    for (uint32_t i = 0; i < l->watch.n; i++)
        some |= l->watch.sources[i].video != NULL;
    return some;
}

static adcgs_status prepare(adcgs_live *l, adcgs_error *error)
{
    double begin = INFINITY;
    ADCGS_TRY(adcgs_source_cameras_read(&l->watch.sources, &l->watch.n, l->path, error));
    l->watch.cameras = calloc(l->watch.n, sizeof *l->watch.cameras);
    l->told = calloc(l->watch.n, 1);
    if (!l->watch.cameras || !l->told)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", l->path);
    for (uint32_t i = 0; i < l->watch.n; i++)
        begin = fmin(begin, l->watch.sources[i].offset);
    for (uint32_t i = 0; i < l->watch.n; i++)
        adcgs_live_camera_init(&l->watch.cameras[i], &l->watch.sources[i], begin);
    if (!has_videos(l))
        *l->watch.folder = '\0';
    else if (!mkdtemp(l->watch.folder)) {
        adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot store footage there: %s", l->watch.folder, strerror(errno));
        *l->watch.folder = '\0';
        return ADCGS_ERR_IO;
    }
    return adcgs_live_watch_start(&l->watch, error);
}

adcgs_status adcgs_live_open(adcgs_live **out, const char *path, const adcgs_live_options *options, adcgs_error *error)
{
    adcgs_live *l = *out = calloc(1, sizeof *l);
    if (!l)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    l->points_path = options->points_path;
    l->watch.seconds = options->seconds;
    l->watch.unbounded = options->unbounded;
    l->watch.interrupted = options->interrupted;
    l->watch.goes_on = options->scale > 0;
    memcpy(l->watch.span, options->last, sizeof options->last);
    memcpy(l->origin, options->origin, sizeof l->origin);
    l->scale = options->scale;
    adcgs_status status = find_paths(l, path, error);
    if (status == ADCGS_OK)
        status = prepare(l, error);
    if (status != ADCGS_OK)
        adcgs_live_close(out);
    return status;
}

static void remove_folder(const char *folder)
{
    DIR *directory = folder && *folder ? opendir(folder) : NULL;
    if (!directory)
        return;
    for (struct dirent *entry; (entry = readdir(directory));)
        if (entry->d_name[0] != '.')
            unlinkat(dirfd(directory), entry->d_name, 0);
    closedir(directory);
    rmdir(folder);
}

void adcgs_live_close(adcgs_live **live)
{
    adcgs_live *l = *live;
    if (!l)
        return;
    adcgs_live_watch_stop(&l->watch);
    for (uint32_t i = 0; l->watch.cameras && i < l->watch.n; i++)
        adcgs_live_camera_clear(&l->watch.cameras[i]);
    remove_folder(l->watch.folder);
    adcgs_scene_free(&l->whole);
    adcgs_source_cameras_free(&l->watch.sources, l->watch.n);
    free(l->watch.cameras);
    free(l->told);
    free(l->watch.folder);
    free(l->watch.end_path);
    free(l->path);
    free(l);
    *live = NULL;
}
