/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The layout of HyperNeRF and Nerfies. */
#include "config.h"

#include "scene/layouts/hypernerf.h"

#include "scene/camera_json.h"
#include "scene/layouts/view_lens.h"
#include "scene/pose_check.h"
#include "system/paths.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define IDS_MAX 1000000  /* names of a list; chosen by hand, not measured, as are the other bounds */
#define ID_BYTES_MAX 200 /* of a name */
#define WARP_MAX 1e9     /* largest frame number */
#define WORLD_MAX 1e9    /* largest coordinate, in files and after conversion */
#define BEND_MAX 1e6     /* largest skew in pixels and distortion coefficient */
#define DIVIDE_MAX 64    /* largest N of rgb/Nx */
#define RULE_PERIOD 4    /* without val_ids, one of this many ids is for training; definition: the rule of other readers ... */
#define RULE_TEST 2      /* ... and the one at this offset for testing; definition: the same rule */

typedef struct reader {
    adcgs_scene *scene;
    adcgs_error *error;
    json_t *dataset, *metadata;
    char *dataset_path, *metadata_path;
    char *images; /**< folder of the images */
    int divide;   /**< cameras are for images larger by this factor */
    double centre[3], scale;
    double last;   /**< largest warp_id */
    json_t *taken; /**< keys: ids that have a view */
} reader;

int adcgs_is_hypernerf(const char *folder)
{
    return adcgs_is_there_at("%s/dataset.json", folder) && adcgs_is_there_at("%s/metadata.json", folder) &&
           adcgs_is_there_at("%s/camera/.", folder);
}

/* ---- Fields ---- */

/** Reads a required number. */
static adcgs_status need_number(const adcgs_json_place *at, const char *field, double min, double max, double *value)
{
    int found;
    ADCGS_TRY(adcgs_json_number(at, field, min, max, value, &found));
    return found ? ADCGS_OK : adcgs_json_bad(at, ADCGS_ERR_DATA, field, "missing");
}

/** Reads an array of exactly n numbers; messages call it `name`. */
static adcgs_status read_array(const adcgs_json_place *at, const char *name, json_t *array, size_t n, double max, double *values)
{
    if (!json_is_array(array) || json_array_size(array) != n)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "expected %zu numbers", n);
    for (size_t i = 0; i < n; i++) {
        json_t *item = json_array_get(array, i);
        if (!json_is_number(item))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "expected %zu numbers", n);
        values[i] = json_number_value(item);
        if (!(fabs(values[i]) <= max))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "%g, expected %g to %g", values[i], -max, max);
    }
    return ADCGS_OK;
}

static adcgs_status need_array(const adcgs_json_place *at, const char *field, size_t n, double max, double *values)
{
    json_t *array = json_object_get(at->root, field);
    return array ? read_array(at, field, array, n, max, values) : adcgs_json_bad(at, ADCGS_ERR_DATA, field, "missing");
}

/* ---- Cameras ---- */

/** Reads an optional array. */
static adcgs_status read_terms(const adcgs_json_place *at, const char *field, size_t n, double *values)
{
    json_t *item = json_object_get(at->root, field);
    return item ? read_array(at, field, item, n, BEND_MAX, values) : ADCGS_OK;
}

/**
 * Distortion is OpenCV's, [k1, k2, k3] and [p1, p2]. skew is in pixels and multiplies the distorted y. So it is divided like
 * the focal length for smaller images.
 */
static adcgs_status read_lens(const reader *r, const adcgs_json_place *at, adcgs_lens *lens)
{
    double focal, aspect = 1.0, principal[2];
    int found;
    ADCGS_TRY(adcgs_json_number(at, "skew", -BEND_MAX, BEND_MAX, &lens->skew, &found));
    ADCGS_TRY(read_terms(at, "radial_distortion", 3, lens->k));
    ADCGS_TRY(read_terms(at, "tangential_distortion", 2, lens->p));
    ADCGS_TRY(read_terms(at, "tangential", 2, lens->p)); /* the older name */
    ADCGS_TRY(need_number(at, "focal_length", 1e-3, 1e9, &focal));
    ADCGS_TRY(adcgs_json_number(at, "pixel_aspect_ratio", 1e-3, 1e3, &aspect, &found));
    ADCGS_TRY(need_array(at, "principal_point", 2, 1e6, principal));
    lens->skew /= r->divide;
    lens->fx = focal / r->divide;
    lens->fy = focal * aspect / r->divide;
    lens->cx = principal[0] / r->divide;
    lens->cy = principal[1] / r->divide;
    return ADCGS_OK;
}

/** The rows of orientation are the camera's axes in the world, and so the columns of the camera-to-world rotation. */
static adcgs_status read_pose(const reader *r, const adcgs_json_place *at, adcgs_camera *camera)
{
    const char *field = "orientation";
    json_t *rows = json_object_get(at->root, field);
    double row[3], position[3];
    if (!json_is_array(rows) || json_array_size(rows) != 3)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected 3 rows of 3 numbers");
    for (int i = 0; i < 3; i++) {
        ADCGS_TRY(read_array(at, field, json_array_get(rows, (size_t)i), 3, WORLD_MAX, row));
        for (int j = 0; j < 3; j++)
            camera->cam_to_world[4 * j + i] = row[j];
    }
    ADCGS_TRY(need_array(at, "position", 3, WORLD_MAX, position));
    for (int j = 0; j < 3; j++) {
        double *c = &camera->cam_to_world[4 * j + 3];
        *c = (position[j] - r->centre[j]) * r->scale;
        if (!(fabs(*c) <= WORLD_MAX))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "position", "%g with the scene's center and scale, expected at most %g", *c,
                                  WORLD_MAX);
    }
    const char *wrong = adcgs_pose_check(camera->cam_to_world);
    return wrong ? adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%s", wrong) : ADCGS_OK;
}

/** Reads the image's size: image_size, or for a reduced image its own size, which results from rounding. */
static adcgs_status read_size(const reader *r, const adcgs_json_place *at, const char *image, adcgs_lens *lens)
{
    double size[2];
    ADCGS_TRY(need_array(at, "image_size", 2, ADCGS_IMAGE_MAX, size));
    for (int i = 0; i < 2; i++)
        if (size[i] < 1.0 || size[i] != floor(size[i]))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "image_size", "%g, expected a whole number of pixels", size[i]);
    lens->width = (int32_t)size[0];
    lens->height = (int32_t)size[1];
    if (r->divide == 1)
        return ADCGS_OK;
    int width, height, channels;
    ADCGS_TRY(adcgs_image_probe(&width, &height, &channels, image, r->error));
    if (fabs(width - size[0] / r->divide) >= 1.0 || fabs(height - size[1] / r->divide) >= 1.0)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected %gx%g, which is image_size of its camera over %d",
                          image, width, height, size[0] / r->divide, size[1] / r->divide, r->divide);
    lens->width = width;
    lens->height = height;
    return ADCGS_OK;
}

static adcgs_status read_camera(const reader *r, const char *id, adcgs_scene_view *view)
{
    char *path = adcgs_path("%s/camera/%s.json", r->scene->directory, id);
    if (!path)
        return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
    adcgs_json_place at = {.path = path, .error = r->error};
    adcgs_status status = adcgs_json_load(&at.root, path, r->error);
    if (status == ADCGS_OK)
        status = read_lens(r, &at, &view->lens);
    if (status == ADCGS_OK)
        status = read_pose(r, &at, &view->camera);
    if (status == ADCGS_OK)
        status = read_size(r, &at, view->path, &view->lens);
    if (status == ADCGS_OK)
        status = adcgs_view_lens(r->scene, view, path, r->error);
    json_decref(at.root);
    free(path);
    snprintf(view->camera.name, sizeof view->camera.name, "%s", id);
    return status;
}

/* ---- Views ---- */

static adcgs_status read_warp(const reader *r, const char *id, json_t *entry, double *warp)
{
    const adcgs_json_place at = {.path = r->metadata_path, .root = r->metadata, .error = r->error};
    json_t *item = json_object_get(entry, "warp_id");
    if (!json_is_integer(item) || json_integer_value(item) < 0 || (double)json_integer_value(item) > WARP_MAX)
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, id, "warp_id: expected a whole number from 0 to %g", WARP_MAX);
    *warp = (double)json_integer_value(item);
    return ADCGS_OK;
}

static adcgs_status find_last(reader *r)
{
    const char *id;
    json_t *entry;
    json_object_foreach(r->metadata, id, entry)
    {
        double warp;
        ADCGS_TRY(read_warp(r, id, entry, &warp));
        r->last = fmax(r->last, warp);
    }
    return ADCGS_OK;
}

/** Finds the image of an id. folder, from malloc(), ends with a slash, and is freed. *out is NULL if there is none. */
static adcgs_status find_file(const reader *r, char *folder, const char *id, char **out)
{
    char *stem = folder ? adcgs_path("%s%s", folder, id) : NULL;
    adcgs_status status =
        stem ? adcgs_find_image(out, stem, r->error) : adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->images);
    if (status == ADCGS_OK && !*out)
        status = adcgs_find_image_like(out, folder, id, r->error);
    free(stem);
    free(folder);
    return status;
}

/** Finds the mask of an id in mask/Nx/, next to the images, if there is one. */
static adcgs_status find_mask(const reader *r, const char *id, char **mask)
{
    return find_file(r, adcgs_path("%s/mask/%dx/", r->scene->directory, r->divide), id, mask);
}

/** On failure view->path is set or NULL; it is freed with the scene. */
static adcgs_status read_view(const reader *r, const char *id, adcgs_scene_view *view)
{
    const adcgs_json_place at = {.path = r->metadata_path, .root = r->metadata, .error = r->error};
    json_t *entry = json_object_get(r->metadata, id);
    double warp;
    if (!entry)
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, id, "missing");
    ADCGS_TRY(read_warp(r, id, entry, &warp));
    view->time = r->last > 0.0 ? warp / r->last : 0.0;
    ADCGS_TRY(find_file(r, adcgs_path("%s/", r->images), id, &view->path));
    if (!view->path)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: no image of %s", r->images, id);
    ADCGS_TRY(find_mask(r, id, &view->mask));
    return read_camera(r, id, view);
}

/** Takes an id that can be a file name and has not been taken before. */
static adcgs_status take_id(const reader *r, const char *field, size_t index, json_t *item, const char **id)
{
    const adcgs_json_place at = {.path = r->dataset_path, .root = r->dataset, .error = r->error};
    const char *text = json_string_value(item);
    char place[64];
    snprintf(place, sizeof place, "%s[%zu]", field, index);
    if (!text || !*text || strlen(text) > ID_BYTES_MAX || strchr(text, '/'))
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, place, "expected the name of an image");
    if (json_object_get(r->taken, text))
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, place, "%s is listed twice", text);
    if (json_object_set_new(r->taken, text, json_true()))
        return adcgs_json_bad(&at, ADCGS_ERR_MEMORY, place, "out of memory");
    *id = text;
    return ADCGS_OK;
}

/** Reads the views of one split: every step-th id of a list, beginning with number `first`. */
static adcgs_status read_list(const reader *r, const char *field, size_t first, size_t step, adcgs_split split)
{
    const adcgs_json_place at = {.path = r->dataset_path, .root = r->dataset, .error = r->error};
    json_t *list = json_object_get(r->dataset, field);
    const size_t n = json_array_size(list);
    if (!json_is_array(list) || n > IDS_MAX)
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, field, "expected an array of at most %d names", IDS_MAX);
    if (split == ADCGS_SPLIT_TRAIN && !n)
        return adcgs_json_bad(&at, ADCGS_ERR_DATA, field, "is empty");
    adcgs_scene_view *views = calloc(n / step + 1, sizeof *views);
    if (!views)
        return adcgs_json_bad(&at, ADCGS_ERR_MEMORY, field, "out of memory");
    r->scene->views[split] = views;
    for (size_t i = first; i < n; i += step) {
        const char *id = NULL;
        ADCGS_TRY(take_id(r, field, i, json_array_get(list, i), &id));
        ADCGS_TRY(read_view(r, id, &views[r->scene->n_views[split]++]));
    }
    return ADCGS_OK;
}

static adcgs_status read_lists(const reader *r)
{
    json_t *val = json_object_get(r->dataset, "val_ids");
    if (val && !(json_is_array(val) && json_array_size(val) == 0)) {
        ADCGS_TRY(read_list(r, "train_ids", 0, 1, ADCGS_SPLIT_TRAIN));
        return read_list(r, "val_ids", 0, 1, ADCGS_SPLIT_TEST);
    }
    ADCGS_TRY(read_list(r, "ids", 0, RULE_PERIOD, ADCGS_SPLIT_TRAIN));
    return read_list(r, "ids", RULE_TEST, RULE_PERIOD, ADCGS_SPLIT_TEST);
}

/* ---- The scene ---- */

static adcgs_status read_coordinates(reader *r)
{
    char *path = adcgs_path("%s/scene.json", r->scene->directory);
    if (!path)
        return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
    adcgs_json_place at = {.path = path, .error = r->error};
    adcgs_status status = adcgs_json_load(&at.root, path, r->error);
    if (status == ADCGS_OK)
        status = need_array(&at, "center", 3, WORLD_MAX, r->centre);
    if (status == ADCGS_OK)
        status = need_number(&at, "scale", 1e-9, 1e9, &r->scale);
    json_decref(at.root);
    free(path);
    return status;
}

/** The N of a folder name Nx; 0 for other names. */
static int parse_divide(const char *name)
{
    int n = 0;
    while (*name >= '0' && *name <= '9' && n <= DIVIDE_MAX)
        n = 10 * n + (*name++ - '0');
    return n <= DIVIDE_MAX && !strcmp(name, "x") ? n : 0;
}

/** Finds the folder of the largest images. */
static adcgs_status find_images(reader *r)
{
    char *rgb = adcgs_path("%s/rgb", r->scene->directory);
    DIR *directory = rgb ? opendir(rgb) : NULL;
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        const int n = parse_divide(entry->d_name);
        char *path = n && (!r->divide || n < r->divide) ? adcgs_path("%s/%s", rgb, entry->d_name) : NULL;
        if (adcgs_is_folder(path)) {
            free(r->images);
            r->images = path;
            r->divide = n;
        } else
            free(path);
    }
    if (directory)
        closedir(directory);
    free(rgb);
    return r->images ? ADCGS_OK
                     : adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: no folder of images, expected rgb/1x or another rgb/Nx",
                                  r->scene->directory);
}

/** Converts a point to working coordinates. */
static adcgs_status move_point(const reader *r, const char *path, uint32_t index, double position[3])
{
    for (int a = 0; a < 3; a++) {
        const double x = (position[a] - r->centre[a]) * r->scale;
        if (!(fabs(x) <= WORLD_MAX))
            return adcgs_fail(r->error, ADCGS_ERR_DATA,
                              "%s: point %u: %c is %g with the scene's center and scale, at most %g "
                              "is expected",
                              path, index, "xyz"[a], x, WORLD_MAX);
        position[a] = x;
    }
    return ADCGS_OK;
}

static adcgs_status read_points(const reader *r)
{
    adcgs_points *points = &r->scene->points;
    char *path = adcgs_path("%s/points.npy", r->scene->directory);
    adcgs_status status = ADCGS_OK;
    if (!path)
        status = adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
    else if (adcgs_is_there(path))
        status = adcgs_points_read(points, path, r->error);
    for (uint32_t i = 0; status == ADCGS_OK && i < points->n; i++)
        status = move_point(r, path, i, points->position[i]);
    if (status == ADCGS_OK)
        adcgs_points_round(points);
    free(path);
    return status;
}

static adcgs_status read_folder(reader *r, int with_points)
{
    if (!r->dataset_path || !r->metadata_path || !r->taken)
        return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
    ADCGS_TRY(adcgs_json_load(&r->dataset, r->dataset_path, r->error));
    ADCGS_TRY(adcgs_json_load(&r->metadata, r->metadata_path, r->error));
    ADCGS_TRY(find_last(r));
    ADCGS_TRY(read_coordinates(r));
    ADCGS_TRY(find_images(r));
    ADCGS_TRY(read_lists(r));
    r->scene->intervals = r->last;
    r->scene->axes = adcgs_pose_axes(r->scene->views[ADCGS_SPLIT_TRAIN], r->scene->n_views[ADCGS_SPLIT_TRAIN]);
    return with_points ? read_points(r) : ADCGS_OK;
}

adcgs_status adcgs_hypernerf_read(adcgs_scene *scene, int with_points, adcgs_error *error)
{
    reader r = {.scene = scene,
                .error = error,
                .dataset_path = adcgs_path("%s/dataset.json", scene->directory),
                .metadata_path = adcgs_path("%s/metadata.json", scene->directory),
                .taken = json_object()};
    const adcgs_status status = read_folder(&r, with_points);
    json_decref(r.dataset);
    json_decref(r.metadata);
    json_decref(r.taken);
    free(r.dataset_path);
    free(r.metadata_path);
    free(r.images);
    return status;
}
