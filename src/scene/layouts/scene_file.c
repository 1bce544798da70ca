/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The adcgs scene file: the file as a whole, its world, its times and its initial points. */
#include "config.h"

#include "scene/layouts/scene_file.h"

#include "scene/layouts/scene_reader.h"
#include "scene/pose_check.h"

#include <math.h>
#include <stdlib.h>

/* Origin: definition. */
#define FILE_VERSION 1 /* of adcgs scene files (doc/scene-file.md) */
#define UNIT_METRE 1   /* a code of adcgs_stream (stream.h) */

static const char *const root_fields[] = {"adcgs_scene",  "name",  "frame_rate",   "scale",    "unit",    "up", "points",
                                          "points_scale", "sound", "sound_offset", "defaults", "cameras", NULL};

/* ---- Times ---- */

/** Removes other splits' views outside the time range of the training views, where the scene is unknown. */
static void fit_times(adcgs_scene *scene, int split, double begin, double slack)
{
    adcgs_scene_view *views = scene->views[split];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < scene->n_views[split]; i++) {
        const double time = views[i].time - begin;
        if (time < -slack || time > scene->duration + slack) {
            adcgs_scene_view_clear(&views[i]);
            continue;
        }
        views[kept] = views[i];
        views[kept++].time = scene->duration > 0.0 ? fmin(fmax(time / scene->duration, 0.0), 1.0) : 0.0;
    }
    scene->n_views[split] = kept;
}

/** Converts seconds to [0,1]. */
static void set_times(adcgs_scene *scene)
{
    const adcgs_scene_view *train = scene->views[ADCGS_SPLIT_TRAIN];
    double begin = train[0].time, end = train[0].time;
    for (uint32_t i = 1; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++) {
        begin = fmin(begin, train[i].time);
        end = fmax(end, train[i].time);
    }
    scene->duration = end - begin;
    scene->sound_begin -= begin;
    const double slack = ADCGS_TIME_TOLERANCE * fmax(scene->duration, 1.0);
    for (int split = 0; split < ADCGS_SPLITS; split++)
        fit_times(scene, split, begin, slack);
}

/* ---- The file ---- */

static adcgs_status read_world(adcgs_scene_reader *r, const adcgs_json_place *at)
{
    static const struct {
        const char *name;
        uint8_t axes;
    } ups[] = {{"y", ADCGS_AXES_Y_UP}, {"z", ADCGS_AXES_Z_UP}, {"-y", ADCGS_AXES_Y_DOWN}};
    const char *unit, *up;
    int found;
    r->scale = 1.0;
    ADCGS_TRY(adcgs_json_number(at, "scale", 1e-9, 1e9, &r->scale, &found));
    ADCGS_TRY(adcgs_json_fps(at, "frame_rate", &r->rate, &found));
    ADCGS_TRY(adcgs_scene_camera_string(at, "unit", &unit));
    if (unit && strcmp(unit, "metre"))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "unit", "%.32s, expected metre; leave it out if it is unknown", unit);
    r->scene->units = unit ? UNIT_METRE : 0;
    ADCGS_TRY(adcgs_scene_camera_string(at, "up", &up));
    r->scene->axes = ADCGS_AXES_UNKNOWN;
    for (size_t i = 0; up && i < ADCGS_COUNTOF(ups); i++)
        if (!strcmp(up, ups[i].name))
            r->scene->axes = ups[i].axes;
    if (up && r->scene->axes == ADCGS_AXES_UNKNOWN)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "up", "%.32s, expected y, z or -y", up);
    return ADCGS_OK;
}

static adcgs_status read_points(const adcgs_scene_reader *r, const adcgs_json_place *at)
{
    adcgs_points *points = &r->scene->points;
    const char *name;
    double scale = r->scale;
    int found;
    ADCGS_TRY(adcgs_scene_camera_string(at, "points", &name));
    ADCGS_TRY(adcgs_json_number(at, "points_scale", 1e-9, 1e9, &scale, &found));
    if (!name)
        return adcgs_points_alloc(points, 0, r->path, r->error);
    char *path = adcgs_scene_resolve(r, name);
    const adcgs_status status =
        path ? adcgs_points_read(points, path, r->error) : adcgs_json_bad(at, ADCGS_ERR_MEMORY, "points", "out of memory");
    free(path);
    ADCGS_TRY(status);
    for (uint32_t i = 0; i < points->n; i++)
        for (int a = 0; a < 3; a++) {
            const double x = points->position[i][a] * scale;
            if (!(fabs(x) <= ADCGS_SCENE_WORLD_MAX))
                return adcgs_json_bad(at, ADCGS_ERR_DATA, "points", "point %u: %c is %g, expected at most %g", i, "xyz"[a], x,
                                      ADCGS_SCENE_WORLD_MAX);
            points->position[i][a] = x;
        }
    adcgs_points_round(points);
    return ADCGS_OK;
}

/** Reads the sound, which players use and training does not. A page publishes it: no scene may name a file elsewhere. */
static adcgs_status read_sound(adcgs_scene_reader *r, const adcgs_json_place *at)
{
    const char *sound;
    int found;
    ADCGS_TRY(adcgs_scene_camera_string(at, "sound", &sound));
    ADCGS_TRY(adcgs_json_number(at, "sound_offset", -1e6, 1e6, &r->scene->sound_begin, &found));
    if (!sound)
        return found ? adcgs_json_bad(at, ADCGS_ERR_DATA, "sound_offset", "expected a sound as well") : ADCGS_OK;
    if (!*sound || strchr(sound, '/'))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "sound", "%.100s, expected the name of a file in the scene's folder", sound);
    free(r->scene->sound);
    r->scene->sound = adcgs_scene_resolve(r, sound);
    return r->scene->sound ? ADCGS_OK : adcgs_json_bad(at, ADCGS_ERR_MEMORY, "sound", "out of memory");
}

static adcgs_status read_root(adcgs_scene_reader *r, int with_points)
{
    const adcgs_json_place at = {.path = r->path, .root = r->root, .error = r->error};
    json_t *version = json_object_get(r->root, "adcgs_scene");
    const char *name;
    if (!json_is_integer(version) || json_integer_value(version) != FILE_VERSION)
        return adcgs_json_bad(&at, json_is_integer(version) ? ADCGS_ERR_UNSUPPORTED : ADCGS_ERR_DATA, "adcgs_scene",
                              "expected version %d", FILE_VERSION);
    ADCGS_TRY(adcgs_scene_camera_fields(&at, "", r->root, root_fields));
    ADCGS_TRY(adcgs_scene_camera_string(&at, "name", &name));
    ADCGS_TRY(read_world(r, &at));
    ADCGS_TRY(read_sound(r, &at));
    ADCGS_TRY(adcgs_scene_cameras_read(r, &at));
    if (r->listing)
        return ADCGS_OK;
    set_times(r->scene);
    if (r->scene->axes == ADCGS_AXES_UNKNOWN)
        r->scene->axes = adcgs_pose_axes(r->scene->views[ADCGS_SPLIT_TRAIN], r->scene->n_views[ADCGS_SPLIT_TRAIN]);
    return with_points ? read_points(r, &at) : ADCGS_OK;
}

static adcgs_status read_file(adcgs_scene_reader *r, int with_points)
{
    ADCGS_TRY(adcgs_json_load(&r->root, r->path, r->error));
    const char *slash = strrchr(r->path, '/');
    r->folder = adcgs_path("%.*s", slash ? (int)(slash - r->path + 1) : 0, r->path);
    const adcgs_status status =
        r->folder ? read_root(r, with_points) : adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->path);
    free(r->folder);
    json_decref(r->root);
    return status;
}

adcgs_status adcgs_scene_file_read(adcgs_scene *scene, const char *path, const adcgs_frame_range *frames, int with_points,
                                   const adcgs_footage *taken, adcgs_error *error)
{
    adcgs_scene_reader r = {.scene = scene, .error = error, .frames = frames, .path = path, .taken = taken};
    return read_file(&r, with_points);
}

adcgs_status adcgs_source_cameras_read(adcgs_source_camera **out, uint32_t *n, const char *path, adcgs_error *error)
{
    adcgs_scene unused = {.n_times = 0};
    adcgs_scene_reader r = {.scene = &unused, .error = error, .path = path, .listing = 1};
    const adcgs_status status = read_file(&r, 0);
    free(unused.sound);
    *out = r.sources;
    *n = r.n_sources;
    return status;
}

void adcgs_source_cameras_free(adcgs_source_camera **cameras, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        free((*cameras)[i].video);
        free((*cameras)[i].folder);
        free((*cameras)[i].images);
    }
    free(*cameras);
    *cameras = NULL;
}
