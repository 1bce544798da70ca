/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The adcgs scene file. */
#include "config.h"

#include "layouts/scene_file.h"

#include "data/paths.h"
#include "data/pose_check.h"
#include "layouts/calibration.h"
#include "layouts/footage.h"

#include <math.h>
#include <stdlib.h>

#define FILE_VERSION 1
#define CAMERAS_MAX 10000
#define FRAME_MAX 1e9
#define DEFAULT_FRAME_RATE ((adcgs_fps){30, 1})
#define WORLD_MAX 1e9
#define UNIT_METRE 1 /* a code of adcgs_stream */

typedef struct reader {
    adcgs_scene *scene;
    adcgs_error *error;
    const adcgs_frame_range *frames;
    const char *path;
    char *folder; /**< of the file, with its slash, or "" */
    json_t *root;
    double scale;                 /**< factor of positions */
    adcgs_fps rate;               /**< of the whole file; unknown: not given */
    const adcgs_footage *taken;   /**< footage of the next training camera; NULL: use the footage named by the file */
    int listing;                  /**< cameras are listed without reading their footage */
    adcgs_source_camera *sources; /**< the training cameras, if listing */
    uint32_t n_sources;
} reader;

static const char *const root_fields[] = {"adcgs_scene", "name",         "frame_rate", "scale",   "unit", "up",
                                          "points",      "points_scale", "defaults",   "cameras", NULL};
/* Fields of a camera; the first OWN_FIELDS cannot be shared. */
static const char *const camera_fields[] = {"name",
                                            "camera_to_world",
                                            "world_to_camera",
                                            "R",
                                            "t",
                                            "video",
                                            "axes",
                                            "pixel_centre",
                                            "width",
                                            "height",
                                            "fx",
                                            "fy",
                                            "cx",
                                            "cy",
                                            "skew",
                                            "lens",
                                            "k1",
                                            "k2",
                                            "k3",
                                            "k4",
                                            "k5",
                                            "k6",
                                            "p1",
                                            "p2",
                                            "images",
                                            "masks",
                                            "first",
                                            "count",
                                            "frame_rate",
                                            "time_offset",
                                            "split",
                                            NULL};
#define OWN_FIELDS 6

/** The path of a name in the file, from malloc(). */
static char *resolve(const reader *r, const char *name)
{
    return adcgs_path("%s%s", *name == '/' ? "" : r->folder, name);
}

/* ---- Cameras ---- */

static adcgs_status read_whole(const adcgs_json_place *at, const char *field, int64_t *value)
{
    double number = (double)*value;
    int found;
    ADCGS_TRY(adcgs_json_number(at, field, 0.0, FRAME_MAX, &number, &found));
    if (number != floor(number))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%g, expected a whole number", number);
    *value = (int64_t)number;
    return ADCGS_OK;
}

/** Location of a camera's frames. */
typedef struct place_of_footage {
    const char *video, *images;
    int64_t first, count;
} place_of_footage;

static adcgs_status find_footage(const adcgs_json_place *at, place_of_footage *where)
{
    *where = (place_of_footage){.first = 0};
    ADCGS_TRY(adcgs_scene_camera_string(at, "video", &where->video));
    ADCGS_TRY(adcgs_scene_camera_string(at, "images", &where->images));
    ADCGS_TRY(read_whole(at, "first", &where->first));
    ADCGS_TRY(read_whole(at, "count", &where->count));
    if (!where->video == !where->images)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "video", "expected either video or images");
    if (where->video && (where->first || where->count))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, where->first ? "first" : "count",
                              "is for images only: for a video use --frames");
    return ADCGS_OK;
}

static const char *folder_of_images(const reader *r, const char *images)
{
    return *images == '/' ? "" : r->folder;
}

static adcgs_status open_footage(const reader *r, const adcgs_json_place *at, adcgs_footage *footage)
{
    place_of_footage where;
    ADCGS_TRY(find_footage(at, &where));
    if (where.images)
        return adcgs_footage_pattern(footage, folder_of_images(r, where.images), where.images, where.first, where.count,
                                     r->error);
    char *path = resolve(r, where.video);
    const adcgs_status status =
        path ? adcgs_footage_video(footage, path, r->error) : adcgs_json_bad(at, ADCGS_ERR_MEMORY, "video", "out of memory");
    free(path);
    return status;
}

static adcgs_status read_split(const adcgs_json_place *at, adcgs_split *split)
{
    const char *name;
    *split = ADCGS_SPLIT_TRAIN;
    ADCGS_TRY(adcgs_scene_camera_string(at, "split", &name));
    if (name && adcgs_split_parse(name, split))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "split", "%.32s, expected train, val or test", name);
    return ADCGS_OK;
}

/** Reads frames per second: the camera's, else the file's, else the video's. */
static adcgs_status read_rate(const reader *r, const adcgs_json_place *at, const adcgs_footage *footage, adcgs_fps *rate)
{
    int found;
    *rate = r->rate.den ? r->rate : footage->rate.den ? footage->rate : DEFAULT_FRAME_RATE;
    return adcgs_json_fps(at, "frame_rate", rate, &found);
}

/** Converts a pose to world units. */
static adcgs_status scale_pose(const reader *r, const adcgs_json_place *at, double pose[12])
{
    for (int i = 0; i < 3; i++) {
        pose[4 * i + 3] *= r->scale;
        if (!(fabs(pose[4 * i + 3]) <= WORLD_MAX))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "name", "the camera is at %g, expected at most %g", pose[4 * i + 3],
                                  WORLD_MAX);
    }
    return ADCGS_OK;
}

/** A file that exists. */
static const char *first_file(const adcgs_footage *footage)
{
    int64_t i = 0;
    while (!footage->video && i + 1 < footage->frames && !footage->pictures[i])
        i++;
    return footage->video ? footage->video : footage->pictures[i];
}

/** Adds masks to views from first_view on: one mask for all, or one for each, numbered by frame. */
static adcgs_status add_masks(const reader *r, const adcgs_json_place *at, adcgs_split split, uint32_t first_view)
{
    const char *masks;
    int64_t first = 0;
    ADCGS_TRY(adcgs_scene_camera_string(at, "masks", &masks));
    ADCGS_TRY(read_whole(at, "first", &first));
    for (uint32_t i = first_view; masks && i < r->scene->n_views[split]; i++) {
        const int64_t frame = r->frames->begin + (int64_t)(i - first_view) * adcgs_frames_step(r->frames);
        r->scene->views[split][i].mask = adcgs_footage_number(folder_of_images(r, masks), masks, first + frame);
        if (!r->scene->views[split][i].mask)
            return adcgs_json_bad(at, ADCGS_ERR_MEMORY, "masks", "out of memory");
    }
    return ADCGS_OK;
}

/** Adds the views of a camera with known footage, with times in seconds. */
static adcgs_status add_views(const reader *r, const adcgs_json_place *at, const adcgs_footage *footage)
{
    adcgs_scene_camera camera;
    adcgs_split split;
    adcgs_fps rate;
    double offset = 0.0;
    int found;
    const char *const file = first_file(footage);
    ADCGS_TRY(adcgs_scene_camera_read(&camera, at));
    ADCGS_TRY(read_split(at, &split));
    ADCGS_TRY(read_rate(r, at, footage, &rate));
    ADCGS_TRY(adcgs_json_number(at, "time_offset", -1e6, 1e6, &offset, &found));
    ADCGS_TRY(scale_pose(r, at, camera.view.camera.cam_to_world));
    ADCGS_TRY(adcgs_calibrate(&camera.view, &camera.lens, footage->width, footage->height, file, r->error));
    if (split == ADCGS_SPLIT_TRAIN && !r->scene->rate.den)
        r->scene->rate = rate;
    const uint32_t before = r->scene->n_views[split];
    ADCGS_TRY(adcgs_footage_add(r->scene, split, &camera.view, footage, r->frames,
                                offset + (double)r->frames->begin / adcgs_fps_value(rate),
                                (double)adcgs_frames_step(r->frames) / adcgs_fps_value(rate), file, r->error));
    return add_masks(r, at, split, before);
}

/** Adds a camera whose footage is still to arrive. */
static adcgs_status list_camera(reader *r, const adcgs_json_place *at)
{
    static const adcgs_footage none;
    adcgs_source_camera *c = &r->sources[r->n_sources];
    adcgs_scene_camera camera;
    place_of_footage where;
    const char *masks;
    int found;
    ADCGS_TRY(adcgs_scene_camera_read(&camera, at)); /* only to report its errors now */
    ADCGS_TRY(adcgs_scene_camera_string(at, "masks", &masks));
    if (masks && adcgs_footage_is_row(masks))
        return adcgs_json_bad(at, ADCGS_ERR_UNSUPPORTED, "masks", "one mask for each image is not supported for live footage");
    ADCGS_TRY(find_footage(at, &where));
    if (where.images && !adcgs_footage_is_row(where.images))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "images",
                              "expected the name of an image with one number, such as %%d or "
                              "%%05d");
    r->n_sources++;
    memcpy(c->name, camera.view.camera.name, sizeof c->name);
    c->is_input = where.video && !strcmp(where.video, "-");
    for (uint32_t i = 0; c->is_input && i + 1 < r->n_sources; i++)
        if (r->sources[i].is_input)
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "video", "- is standard input, which camera %s already uses",
                                  r->sources[i].name);
    c->video = c->is_input ? strdup("standard input") : where.video ? resolve(r, where.video) : NULL;
    c->folder = where.images ? strdup(folder_of_images(r, where.images)) : NULL;
    c->images = where.images ? strdup(where.images) : NULL;
    if (!c->video && !(c->folder && c->images))
        return adcgs_json_bad(at, ADCGS_ERR_MEMORY, "video", "out of memory");
    c->first = where.first;
    c->count = where.count;
    ADCGS_TRY(read_rate(r, at, &none, &c->rate));
    if (where.video && !r->rate.den && !adcgs_json_find(at, "frame_rate"))
        c->rate = (adcgs_fps){0, 0};
    return adcgs_json_number(at, "time_offset", -1e6, 1e6, &c->offset, &found);
}

/** Adds a training camera whose footage the caller gives. */
static adcgs_status take_camera(reader *r, const adcgs_json_place *at)
{
    return add_views(r, at, r->taken++);
}

static adcgs_status read_camera(reader *r, json_t *defaults, json_t *camera, size_t index, json_t *taken)
{
    const adcgs_json_place at =
        {.path = r->path, .root = defaults, .frame = camera, .index = index, .list = "cameras", .error = r->error};
    adcgs_footage footage = {0};
    if (!json_is_object(camera))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: cameras[%zu]: expected an object", r->path, index);
    ADCGS_TRY(adcgs_scene_camera_fields(&at, "", camera, camera_fields));
    const char *name = json_string_value(json_object_get(camera, "name"));
    if (name && json_object_get(taken, name))
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, "name", "%.64s is used twice", name);
    if (name && json_object_set_new(taken, name, json_true()))
        return adcgs_json_bad(&at, ADCGS_ERR_MEMORY, "name", "out of memory");
    adcgs_split split;
    if (r->taken || r->sources) {
        ADCGS_TRY(read_split(&at, &split));
        return split != ADCGS_SPLIT_TRAIN ? ADCGS_OK : r->sources ? list_camera(r, &at) : take_camera(r, &at);
    }
    adcgs_status status = open_footage(r, &at, &footage);
    if (status == ADCGS_OK)
        status = add_views(r, &at, &footage);
    adcgs_footage_clear(&footage);
    return status;
}

static adcgs_status read_cameras(reader *r, const adcgs_json_place *at)
{
    json_t *defaults = json_object_get(r->root, "defaults"), *cameras = json_object_get(r->root, "cameras");
    const size_t n = json_array_size(cameras);
    if (defaults && !json_is_object(defaults))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "defaults", "expected an object");
    ADCGS_TRY(adcgs_scene_camera_fields(at, "defaults.", defaults, camera_fields + OWN_FIELDS));
    if (!n || n > CAMERAS_MAX)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "cameras", "expected an array of 1 to %d cameras", CAMERAS_MAX);
    json_t *taken = json_object();
    if (r->listing && !(r->sources = calloc(n, sizeof *r->sources))) {
        json_decref(taken);
        return adcgs_json_bad(at, ADCGS_ERR_MEMORY, "cameras", "out of memory");
    }
    adcgs_status status = taken ? ADCGS_OK : adcgs_json_bad(at, ADCGS_ERR_MEMORY, "cameras", "out of memory");
    for (size_t i = 0; status == ADCGS_OK && i < n; i++)
        status = read_camera(r, defaults, json_array_get(cameras, i), i, taken);
    json_decref(taken);
    if (status == ADCGS_OK && !(r->listing ? r->n_sources : r->scene->n_views[ADCGS_SPLIT_TRAIN]))
        status = adcgs_json_bad(at, ADCGS_ERR_DATA, "cameras", "none is for training");
    return status;
}

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
    const double slack = ADCGS_TIME_TOLERANCE * fmax(scene->duration, 1.0);
    for (int split = 0; split < ADCGS_SPLITS; split++)
        fit_times(scene, split, begin, slack);
}

/* ---- The file ---- */

static adcgs_status read_world(reader *r, const adcgs_json_place *at)
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

static adcgs_status read_points(const reader *r, const adcgs_json_place *at)
{
    adcgs_points *points = &r->scene->points;
    const char *name;
    double scale = r->scale;
    int found;
    ADCGS_TRY(adcgs_scene_camera_string(at, "points", &name));
    ADCGS_TRY(adcgs_json_number(at, "points_scale", 1e-9, 1e9, &scale, &found));
    if (!name)
        return adcgs_points_alloc(points, 0, r->path, r->error);
    char *path = resolve(r, name);
    const adcgs_status status =
        path ? adcgs_points_read(points, path, r->error) : adcgs_json_bad(at, ADCGS_ERR_MEMORY, "points", "out of memory");
    free(path);
    ADCGS_TRY(status);
    for (uint32_t i = 0; i < points->n; i++)
        for (int a = 0; a < 3; a++) {
            const double x = points->position[i][a] * scale;
            if (!(fabs(x) <= WORLD_MAX))
                return adcgs_json_bad(at, ADCGS_ERR_DATA, "points", "point %u: %c is %g, expected at most %g", i, "xyz"[a], x,
                                      WORLD_MAX);
            points->position[i][a] = x;
        }
    adcgs_points_round(points);
    return ADCGS_OK;
}

static adcgs_status read_root(reader *r, int with_points)
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
    ADCGS_TRY(read_cameras(r, &at));
    if (r->listing)
        return ADCGS_OK;
    set_times(r->scene);
    if (r->scene->axes == ADCGS_AXES_UNKNOWN)
        r->scene->axes = adcgs_pose_axes(r->scene->views[ADCGS_SPLIT_TRAIN], r->scene->n_views[ADCGS_SPLIT_TRAIN]);
    return with_points ? read_points(r, &at) : ADCGS_OK;
}

static adcgs_status read_file(reader *r, int with_points)
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
    reader r = {.scene = scene, .error = error, .frames = frames, .path = path, .taken = taken};
    return read_file(&r, with_points);
}

adcgs_status adcgs_source_cameras_read(adcgs_source_camera **out, uint32_t *n, const char *path, adcgs_error *error)
{
    adcgs_scene unused = {.n_times = 0};
    reader r = {.scene = &unused, .error = error, .path = path, .listing = 1};
    const adcgs_status status = read_file(&r, 0);
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
