/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The layout of Dynamic 3D Gaussians' Panoptic benchmark. */
#include "config.h"

#include "scene/layouts/panoptic.h"

#include "geometry/rotation.h"
#include "media/arrays/npy.h"
#include "media/arrays/npz.h"
#include "scene/camera_json.h"
#include "scene/layouts/calibration.h"
#include "scene/layouts/footage.h"
#include "scene/pose_check.h"
#include "system/paths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define WORLD_MAX 1e9     /* largest absolute value of elements of matrices, and of coordinates */
#define TIMES_MAX 100000  /* timestamps of a file */
#define CAMERAS_MAX 10000 /* cameras of a timestamp */
#define POINT_COLUMNS 7   /* x, y, z, r, g, b, foreground; definition of init_pt_cld.npz */

typedef struct reader {
    adcgs_scene *scene;
    adcgs_error *error;
    adcgs_json_place at; /**< of the file being read */
    adcgs_split split;
    int32_t wide, high; /**< image size that k is for */
    int width, height;  /**< of the images, from the first one of the split */
    size_t times;       /**< timestamps of the training views */
    json_t *taken;      /**< keys: names of the training images */
} reader;

int adcgs_is_panoptic(const char *folder)
{
    return adcgs_is_there_at("%s/train_meta.json", folder);
}

/** Like adcgs_fail(), with file, field, timestamp and camera in front of the message. */
static adcgs_status bad(const reader *r, const char *field, size_t t, size_t c, const char *text)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s[%zu][%zu]: %s", r->at.path, field, t, c, text);
}

static adcgs_status no_memory(const reader *r)
{
    return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
}

static json_t *find(const reader *r, const char *field, size_t t, size_t c)
{
    return json_array_get(json_array_get(json_object_get(r->at.root, field), t), c);
}

/** Reads an n x n matrix and keeps its first `rows` rows. */
static adcgs_status read_matrix(const reader *r, const char *field, size_t t, size_t c, size_t n, size_t rows, double *values)
{
    json_t *matrix = find(r, field, t, c);
    char text[64];
    snprintf(text, sizeof text, "expected %zu rows of %zu numbers of at most %g", n, n, WORLD_MAX);
    if (json_array_size(matrix) != n)
        return bad(r, field, t, c, text);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            json_t *row = json_array_get(matrix, i), *item = json_array_get(row, j);
            const double value = json_number_value(item);
            if (json_array_size(row) != n || !json_is_number(item) || !(fabs(value) <= WORLD_MAX))
                return bad(r, field, t, c, text);
            if (i < rows)
                values[n * i + j] = value;
        }
    return ADCGS_OK;
}

static adcgs_status read_lens(const reader *r, size_t t, size_t c, adcgs_lens *lens)
{
    double k[9];
    ADCGS_TRY(read_matrix(r, "k", t, c, 3, 3, k));
    if (!(k[0] >= 1e-3 && k[4] >= 1e-3) || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
        return bad(r, "k", t, c, "expected [[fx, skew, cx], [0, fy, cy], [0, 0, 1]]");
    *lens = (adcgs_lens){.width = r->wide, .height = r->high, .fx = k[0], .fy = k[4], .cx = k[2], .cy = k[5], .skew = k[1]};
    return ADCGS_OK;
}

static adcgs_status read_pose(const reader *r, size_t t, size_t c, double pose[12])
{
    char text[128];
    ADCGS_TRY(read_matrix(r, "w2c", t, c, 4, 3, pose));
    const char *wrong = adcgs_pose_check(pose);
    snprintf(text, sizeof text, "the matrix %s", wrong ? wrong : "");
    if (wrong)
        return bad(r, "w2c", t, c, text);
    adcgs_pose_invert(pose);
    return ADCGS_OK;
}

/** Finds an image in another letter case, or with another extension; view->path is NULL if there is none. */
static adcgs_status find_like(const reader *r, const char *name, adcgs_scene_view *view)
{
    char *folder = adcgs_path("%s/ims/", r->scene->directory);
    free(view->path);
    view->path = NULL;
    const adcgs_status status = folder ? adcgs_find_image_like(&view->path, folder, name, r->error) : no_memory(r);
    free(folder);
    return status;
}

/** Finds the image, and its foreground image if there is one. */
static adcgs_status find_files(const reader *r, size_t t, size_t c, adcgs_scene_view *view)
{
    const char *name = json_string_value(find(r, "fn", t, c));
    if (!name || !*name || *name == '/' || strstr(name, "../"))
        return bad(r, "fn", t, c, "expected the name of an image below ims/");
    if (r->split == ADCGS_SPLIT_TRAIN ? json_object_set_new(r->taken, name, json_true()) : 0)
        return no_memory(r);
    if (r->split == ADCGS_SPLIT_TEST && json_object_get(r->taken, name))
        return bad(r, "fn", t, c, "this image is for training, too: a view for testing must not be trained on");
    char *path = adcgs_path("%s/ims/%s", r->scene->directory, name);
    const char *dot = strrchr(name, '.');
    char *seg = adcgs_path("%s/seg/%.*s.png", r->scene->directory, dot ? (int)(dot - name) : (int)strlen(name), name);
    view->path = path;
    view->moving = adcgs_is_there(seg) ? seg : NULL;
    if (!view->moving)
        free(seg);
    if (!path || !seg)
        return no_memory(r);
    if (adcgs_is_there(path) || r->scene->is_outline)
        return ADCGS_OK;
    ADCGS_TRY(find_like(r, name, view));
    return view->path ? ADCGS_OK : bad(r, "fn", t, c, "there is no such image in ims/");
}

/** Names the camera by its number, which all its images share, else by the image's folder. */
static void set_name(const reader *r, size_t t, size_t c, adcgs_camera *camera)
{
    json_t *id = find(r, "cam_id", t, c);
    const char *name = json_string_value(find(r, "fn", t, c)), *slash = strchr(name, '/');
    if (json_is_integer(id))
        snprintf(camera->name, sizeof camera->name, "%lld", (long long)json_integer_value(id));
    else
        snprintf(camera->name, sizeof camera->name, "%.*s", (int)(slash ? slash - name : ADCGS_CAMERA_NAME_MAX), name);
}

/** On failure the view's paths are set or NULL. */
static adcgs_status read_view(reader *r, size_t t, size_t c, adcgs_scene_view *view)
{
    adcgs_lens lens;
    int channels;
    ADCGS_TRY(find_files(r, t, c, view));
    ADCGS_TRY(read_lens(r, t, c, &lens));
    ADCGS_TRY(read_pose(r, t, c, view->camera.cam_to_world));
    if (!r->width)
        ADCGS_TRY(adcgs_image_probe(&r->width, &r->height, &channels, view->path, r->error));
    ADCGS_TRY(adcgs_calibrate(view, &lens, r->width, r->height, view->path, r->error));
    set_name(r, t, c, &view->camera);
    view->time = r->times > 1 ? (double)t / (double)(r->times - 1) : 0.0;
    return ADCGS_OK;
}

/** Counts the cameras of a timestamp, the same number in all fields. */
static adcgs_status count_cameras(const reader *r, size_t t, size_t *n)
{
    static const char *const fields[] = {"fn", "k", "w2c"};
    *n = json_array_size(json_array_get(json_object_get(r->at.root, "fn"), t));
    for (size_t i = 0; i < ADCGS_COUNTOF(fields); i++) {
        const size_t has = json_array_size(json_array_get(json_object_get(r->at.root, fields[i]), t));
        if (has != *n || !*n || *n > CAMERAS_MAX)
            return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s[%zu]: %zu cameras, expected as many as fn has, 1 to %d",
                              r->at.path, fields[i], t, has, CAMERAS_MAX);
    }
    return ADCGS_OK;
}

static adcgs_status read_views(reader *r, size_t times)
{
    for (size_t t = 0, n; t < times; t++) {
        ADCGS_TRY(count_cameras(r, t, &n));
        for (size_t c = 0; c < n; c++) {
            adcgs_scene_view view = {.time = 0.0};
            const adcgs_status status = read_view(r, t, c, &view);
            if (status != ADCGS_OK) {
                adcgs_scene_view_clear(&view);
                return status;
            }
            ADCGS_TRY(adcgs_scene_append(r->scene, r->split, &view, r->at.path, r->error));
        }
    }
    return ADCGS_OK;
}

static adcgs_status read_root(reader *r)
{
    static const char *const fields[] = {"fn", "k", "w2c"};
    const size_t times = json_array_size(json_object_get(r->at.root, "fn"));
    adcgs_camera size;
    int found;
    ADCGS_TRY(adcgs_json_size(&r->at, &size, &found));
    if (!found)
        return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, "w", "missing, expected w and h of the images");
    r->wide = size.width;
    r->high = size.height;
    for (size_t i = 0; i < ADCGS_COUNTOF(fields); i++)
        if (json_array_size(json_object_get(r->at.root, fields[i])) != times || !times || times > TIMES_MAX)
            return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, fields[i], "%zu timestamps, expected as many as fn has, 1 to %d",
                                  json_array_size(json_object_get(r->at.root, fields[i])), TIMES_MAX);
    if (r->split == ADCGS_SPLIT_TRAIN)
        r->times = times;
    else if (times > r->times)
        return adcgs_json_bad(&r->at, ADCGS_ERR_DATA, "fn", "%zu timestamps, expected at most the %zu of train_meta.json", times,
                              r->times);
    return read_views(r, times);
}

static adcgs_status read_meta(reader *r, const char *name, adcgs_split split)
{
    char *path = adcgs_path("%s/%s", r->scene->directory, name);
    if (!path)
        return no_memory(r);
    r->at = (adcgs_json_place){.path = path, .error = r->error};
    r->split = split;
    r->width = r->height = 0;
    adcgs_status status = adcgs_json_load(&r->at.root, path, r->error);
    if (status == ADCGS_OK)
        status = read_root(r);
    json_decref(r->at.root);
    free(path);
    return status;
}

/* ---- Points ---- */

static adcgs_status take_points(const reader *r, const char *path, const adcgs_npy *table)
{
    adcgs_points *points = &r->scene->points;
    ADCGS_TRY(adcgs_points_alloc(points, table->rows, path, r->error));
    points->coloured = 1;
    for (uint32_t i = 0; i < points->n; i++)
        for (uint32_t a = 0; a < 3; a++) {
            const double x = adcgs_npy_value(table, i, a), colour = adcgs_npy_value(table, i, 3 + a);
            if (!(fabs(x) <= WORLD_MAX) || !isfinite(colour))
                return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: point %u: expected finite numbers of at most %g", path, i,
                                  WORLD_MAX);
            points->position[i][a] = x;
            points->colour[i][a] = (uint8_t)(fmin(fmax(colour, 0.0), 1.0) * 255.0 + 0.5);
        }
    adcgs_points_round(points);
    return ADCGS_OK;
}

static adcgs_status read_points(const reader *r)
{
    uint8_t *data = NULL;
    size_t bytes;
    adcgs_npy table;
    if (!adcgs_is_there_at("%s/init_pt_cld.npz", r->scene->directory))
        return ADCGS_OK;
    char *path = adcgs_path("%s/init_pt_cld.npz", r->scene->directory);
    adcgs_status status = path ? adcgs_npz_read(&data, &bytes, path, "data", r->error) : no_memory(r);
    if (status == ADCGS_OK)
        status = adcgs_npy_open(&table, data, bytes, POINT_COLUMNS, "points", path, r->error);
    if (status == ADCGS_OK)
        status = take_points(r, path, &table);
    free(data);
    free(path);
    return status;
}

adcgs_status adcgs_panoptic_read(adcgs_scene *scene, int with_points, adcgs_error *error)
{
    reader r = {.scene = scene, .error = error, .taken = json_object()};
    adcgs_status status = r.taken ? read_meta(&r, "train_meta.json", ADCGS_SPLIT_TRAIN) : no_memory(&r);
    if (status == ADCGS_OK && adcgs_is_there_at("%s/test_meta.json", scene->directory))
        status = read_meta(&r, "test_meta.json", ADCGS_SPLIT_TEST);
    json_decref(r.taken);
    ADCGS_TRY(status);
    scene->intervals = (double)(r.times - 1);
    scene->axes = adcgs_pose_axes(scene->views[ADCGS_SPLIT_TRAIN], scene->n_views[ADCGS_SPLIT_TRAIN]);
    return with_points ? read_points(&r) : ADCGS_OK;
}
