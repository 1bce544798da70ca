/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Cameras of the adcgs scene file: names, intrinsics, poses. */
#include "config.h"

#include "scene/layouts/scene_file.h"

#include "geometry/rotation.h"
#include "scene/pose_check.h"

#include <math.h>
#include <stdio.h>

#define WORLD_MAX 1e9 /* largest absolute value of a number, in world units or pixels; chosen by hand, not measured */

adcgs_status adcgs_scene_camera_fields(const adcgs_json_place *at, const char *prefix, json_t *object, const char *const *known)
{
    const char *key;
    char field[96];
    json_t *value;
    json_object_foreach(object, key, value)
    {
        size_t i = 0;
        while (known[i] && strcmp(known[i], key))
            i++;
        snprintf(field, sizeof field, "%s%.64s", prefix, key);
        if (!known[i])
            return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "unknown field");
    }
    return ADCGS_OK;
}

adcgs_status adcgs_scene_camera_string(const adcgs_json_place *at, const char *field, const char **text)
{
    json_t *item = adcgs_json_find(at, field);
    *text = json_string_value(item);
    if (item && (!*text || !**text || strlen(*text) != json_string_length(item)))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected a text");
    return ADCGS_OK;
}

/* ---- Intrinsics ---- */

static adcgs_status need_number(const adcgs_json_place *at, const char *field, double min, double max, double *value)
{
    int found;
    ADCGS_TRY(adcgs_json_number(at, field, min, max, value, &found));
    return found ? ADCGS_OK : adcgs_json_bad(at, ADCGS_ERR_DATA, field, "missing");
}

static adcgs_status read_size(const adcgs_json_place *at, const char *field, int32_t *size)
{
    double value;
    ADCGS_TRY(need_number(at, field, 1.0, ADCGS_IMAGE_MAX, &value));
    if (value != floor(value))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%g, expected a whole number of pixels", value);
    *size = (int32_t)value;
    return ADCGS_OK;
}

static adcgs_status read_distortion(const adcgs_json_place *at, adcgs_lens *lens)
{
    static const char *const radial[6] = {"k1", "k2", "k3", "k4", "k5", "k6"}, *const tangential[2] = {"p1", "p2"};
    const char *kind;
    int found;
    ADCGS_TRY(adcgs_scene_camera_string(at, "lens", &kind));
    if (kind && strcmp(kind, "opencv") && strcmp(kind, "fisheye"))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "lens", "%.32s, expected opencv or fisheye", kind);
    lens->is_fisheye = kind && *kind == 'f';
    for (int i = 0; i < 8; i++) {
        const char *name = i < 6 ? radial[i] : tangential[i - 6];
        double *value = i < 6 ? &lens->k[i] : &lens->p[i - 6];
        ADCGS_TRY(adcgs_json_number(at, name, -WORLD_MAX, WORLD_MAX, value, &found));
        if (*value != 0.0 && lens->is_fisheye && i >= 4)
            return adcgs_json_bad(at, ADCGS_ERR_DATA, name, "%g, but a fisheye lens has k1 to k4 alone", *value);
    }
    return adcgs_json_number(at, "skew", -WORLD_MAX, WORLD_MAX, &lens->skew, &found);
}

static adcgs_status read_lens(const adcgs_json_place *at, adcgs_lens *lens)
{
    double centre = 0.5;
    int found;
    *lens = (adcgs_lens){0};
    ADCGS_TRY(read_size(at, "width", &lens->width));
    ADCGS_TRY(read_size(at, "height", &lens->height));
    ADCGS_TRY(need_number(at, "fx", 1e-3, 1e9, &lens->fx));
    lens->fy = lens->fx;
    ADCGS_TRY(adcgs_json_number(at, "fy", 1e-3, 1e9, &lens->fy, &found));
    ADCGS_TRY(adcgs_json_number(at, "pixel_centre", 0.0, 0.5, &centre, &found));
    if (centre != 0.0 && centre != 0.5)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "pixel_centre", "%g, expected 0 or 0.5", centre);
    lens->cx = 0.5 * lens->width + centre - 0.5; /* the centre, in the file's convention */
    lens->cy = 0.5 * lens->height + centre - 0.5;
    ADCGS_TRY(adcgs_json_number(at, "cx", -1e6, 1e6, &lens->cx, &found));
    ADCGS_TRY(adcgs_json_number(at, "cy", -1e6, 1e6, &lens->cy, &found));
    lens->cx += 0.5 - centre;
    lens->cy += 0.5 - centre;
    return read_distortion(at, lens);
}

/* ---- Poses ---- */

/** Reads a row of numbers. */
static adcgs_status read_row(const adcgs_json_place *at, const char *field, json_t *row, size_t n, double *values)
{
    for (size_t j = 0; j < n; j++) {
        json_t *item = json_array_get(row, j);
        if (json_array_size(row) != n || !json_is_number(item))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected rows of %zu numbers", n);
        values[j] = json_number_value(item);
        if (!(fabs(values[j]) <= WORLD_MAX))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "%g, expected %g to %g", values[j], -WORLD_MAX, WORLD_MAX);
    }
    return ADCGS_OK;
}

/** Reads 3 rows of 4, or 4 rows with a last one of 0 0 0 1. */
static adcgs_status read_matrix(const adcgs_json_place *at, const char *field, double pose[12])
{
    json_t *rows = json_object_get(at->frame, field);
    const size_t n = json_array_size(rows);
    double last[4];
    if (n != 3 && n != 4)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "expected 3 rows of 4 numbers");
    for (size_t i = 0; i < n; i++)
        ADCGS_TRY(read_row(at, field, json_array_get(rows, i), 4, i < 3 ? pose + 4 * i : last));
    if (n == 4 && (last[0] != 0.0 || last[1] != 0.0 || last[2] != 0.0 || last[3] != 1.0))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, field, "the last row must be 0 0 0 1");
    return ADCGS_OK;
}

/** Reads R and t, x_camera = R x + t: the matrix of world_to_camera in two parts. */
static adcgs_status read_parts(const adcgs_json_place *at, double pose[12])
{
    json_t *rows = json_object_get(at->frame, "R"), *t = json_object_get(at->frame, "t");
    double values[3];
    if (json_array_size(rows) != 3)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "R", "expected 3 rows of 3 numbers");
    for (size_t i = 0; i < 3; i++)
        ADCGS_TRY(read_row(at, "R", json_array_get(rows, i), 3, pose + 4 * i));
    if (json_array_size(t) != 3)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "t", "expected 3 numbers");
    for (size_t i = 0; i < 3; i++) { /* each is a number or a row of one, as many data sets publish it */
        json_t *item = json_array_get(t, i);
        item = json_is_array(item) && json_array_size(item) == 1 ? json_array_get(item, 0) : item;
        values[i] = json_number_value(item);
        if (!json_is_number(item) || !(fabs(values[i]) <= WORLD_MAX))
            return adcgs_json_bad(at, ADCGS_ERR_DATA, "t", "expected 3 numbers of at most %g", WORLD_MAX);
        pose[4 * i + 3] = values[i];
    }
    return ADCGS_OK;
}

/** Returns the field that gives the pose; NULL, with a message, if none or several are present. */
static const char *find_pose(const adcgs_json_place *at)
{
    static const char *const ways[] = {"camera_to_world", "world_to_camera", "R"};
    const char *way = NULL;
    int n = 0;
    for (size_t i = 0; i < ADCGS_COUNTOF(ways); i++)
        if (json_object_get(at->frame, ways[i])) {
            way = ways[i];
            n++;
        }
    if (n == 1 && (!json_object_get(at->frame, "t") || *way == 'R'))
        return way;
    adcgs_json_bad(at, ADCGS_ERR_DATA, "camera_to_world", "expected one of camera_to_world, world_to_camera, and R with t");
    return NULL;
}

static adcgs_status read_pose(const adcgs_json_place *at, double pose[12])
{
    const char *way = find_pose(at), *axes;
    if (!way)
        return ADCGS_ERR_DATA;
    ADCGS_TRY(adcgs_scene_camera_string(at, "axes", &axes));
    if (axes && strcmp(axes, "opencv") && strcmp(axes, "opengl"))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "axes", "%.32s, expected opencv or opengl", axes);
    ADCGS_TRY(*way == 'R' ? read_parts(at, pose) : read_matrix(at, way, pose));
    const char *wrong = adcgs_pose_check(pose);
    if (wrong)
        return adcgs_json_bad(at, ADCGS_ERR_DATA, way, "%s", wrong);
    if (*way != 'c')
        adcgs_pose_invert(pose); /* the rotation has been checked */
    if (axes && !strcmp(axes, "opengl"))
        adcgs_pose_from_opengl(pose);
    return ADCGS_OK;
}

adcgs_status adcgs_scene_camera_read(adcgs_scene_camera *out, const adcgs_json_place *at)
{
    const char *name = json_string_value(json_object_get(at->frame, "name"));
    *out = (adcgs_scene_camera){.view = {.time = 0.0}};
    if (!name || !*name || strlen(name) > ADCGS_CAMERA_NAME_MAX || strchr(name, '/'))
        return adcgs_json_bad(at, ADCGS_ERR_DATA, "name", "expected a text of 1 to %d bytes without /", ADCGS_CAMERA_NAME_MAX);
    snprintf(out->view.camera.name, sizeof out->view.camera.name, "%s", name);
    ADCGS_TRY(read_lens(at, &out->lens));
    return read_pose(at, out->view.camera.cam_to_world);
}
