/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The cameras of a scene file, with their footage: views that are read, or locations of live footage. */
#include "config.h"

#include "scene/layouts/calibration.h"
#include "scene/layouts/footage.h"
#include "scene/layouts/scene_reader.h"

#include <math.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define CAMERAS_MAX 10000                       /* of a scene */
#define FRAME_MAX 1e9                           /* largest number of an image, and number of images */
#define DEFAULT_FRAME_RATE ((adcgs_fps){30, 1}) /* frames per second (doc/scene-file.md) */

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
#define OWN_FIELDS 6 /* fields: name to video, by definition of the file */

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

static const char *folder_of_images(const adcgs_scene_reader *r, const char *images)
{
    return *images == '/' ? "" : r->folder;
}

static adcgs_status open_footage(const adcgs_scene_reader *r, const adcgs_json_place *at, adcgs_footage *footage)
{
    place_of_footage where;
    ADCGS_TRY(find_footage(at, &where));
    if (where.images)
        return adcgs_footage_pattern(footage, folder_of_images(r, where.images), where.images, where.first, where.count,
                                     r->error);
    char *path = adcgs_scene_resolve(r, where.video);
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
static adcgs_status read_rate(const adcgs_scene_reader *r, const adcgs_json_place *at, const adcgs_footage *footage,
                              adcgs_fps *rate)
{
    int found;
    *rate = r->rate.den ? r->rate : footage->rate.den ? footage->rate : DEFAULT_FRAME_RATE;
    return adcgs_json_fps(at, "frame_rate", rate, &found);
}

/** Converts a pose to world units. */
static adcgs_status scale_pose(const adcgs_scene_reader *r, const adcgs_json_place *at, double pose[12])
{
    for (int i = 0; i < 3; i++) {
        pose[4 * i + 3] *= r->scale;
        if (!(fabs(pose[4 * i + 3]) <= ADCGS_SCENE_WORLD_MAX))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "name", "the camera is at %g, expected at most %g", pose[4 * i + 3],
                                  ADCGS_SCENE_WORLD_MAX);
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
static adcgs_status add_masks(const adcgs_scene_reader *r, const adcgs_json_place *at, adcgs_split split, uint32_t first_view)
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
static adcgs_status add_views(const adcgs_scene_reader *r, const adcgs_json_place *at, const adcgs_footage *footage)
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
static adcgs_status list_camera(adcgs_scene_reader *r, const adcgs_json_place *at)
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
    c->video = c->is_input ? strdup("standard input") : where.video ? adcgs_scene_resolve(r, where.video) : NULL;
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
static adcgs_status take_camera(adcgs_scene_reader *r, const adcgs_json_place *at)
{
    return add_views(r, at, r->taken++);
}

static adcgs_status read_camera(adcgs_scene_reader *r, json_t *defaults, json_t *camera, size_t index, json_t *taken)
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

adcgs_status adcgs_scene_cameras_read(adcgs_scene_reader *r, const adcgs_json_place *at)
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
