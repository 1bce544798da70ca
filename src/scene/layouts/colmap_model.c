/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A sparse model of COLMAP in memory. */
#include "config.h"

#include "scene/layouts/colmap_model.h"

#include "geometry/quaternion_matrix.h"
#include "scene/pose_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin: chosen by hand, not measured. */
#define WORLD_MAX 1e9       /* largest absolute value of coordinates and parameters */
#define NAME_BYTES_MAX 1000 /* of an image, with its folders */

void adcgs_colmap_clear(adcgs_colmap *model)
{
    for (size_t i = 0; i < model->n_images; i++)
        free(model->images[i].name);
    free(model->images);
    free(model->cameras);
    free(model->training);
    adcgs_points_free(&model->points);
    *model = (adcgs_colmap){0};
}

adcgs_status adcgs_colmap_bad(const adcgs_colmap *model, adcgs_status status, const char *format, ...)
{
    char what[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return adcgs_fail(model->error, status, "%s: %s %llu: %s", model->path, model->unit, (unsigned long long)model->index, what);
}

/* ---- Cameras ---- */

enum { FX, FY, CX, CY, K1, K2, P1, P2, K3, K4, K5, K6, BOTH }; /* BOTH: one focal length for both axes */

/** The parameters of each kind, in order; a kind without parameters is neither of OpenCV's models. */
static const struct kind {
    const char *name;
    int n, params[ADCGS_COLMAP_PARAMS_MAX];
    int is_fisheye;
} kinds[] = {
    {"SIMPLE_PINHOLE", 3, {BOTH, CX, CY}, 0},
    {"PINHOLE", 4, {FX, FY, CX, CY}, 0},
    {"SIMPLE_RADIAL", 4, {BOTH, CX, CY, K1}, 0},
    {"RADIAL", 5, {BOTH, CX, CY, K1, K2}, 0},
    {"OPENCV", 8, {FX, FY, CX, CY, K1, K2, P1, P2}, 0},
    {"OPENCV_FISHEYE", 8, {FX, FY, CX, CY, K1, K2, K3, K4}, 1},
    {"FULL_OPENCV", 12, {FX, FY, CX, CY, K1, K2, P1, P2, K3, K4, K5, K6}, 0},
    {"FOV", 0, {0}, 0},
    {"SIMPLE_RADIAL_FISHEYE", 4, {BOTH, CX, CY, K1}, 1},
    {"RADIAL_FISHEYE", 5, {BOTH, CX, CY, K1, K2}, 1},
    {"THIN_PRISM_FISHEYE", 0, {0}, 1},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 0, {0}, 1},
};

int adcgs_colmap_kind(const char *name, int64_t number)
{
    for (int i = 0; i < (int)ADCGS_COUNTOF(kinds); i++)
        if (name ? !strcmp(name, kinds[i].name) : number == i)
            return i;
    return -1;
}

adcgs_status adcgs_colmap_params(const adcgs_colmap *model, int kind, int *n)
{
    *n = kinds[kind].n;
    if (!*n)
        return adcgs_colmap_bad(model, ADCGS_ERR_UNSUPPORTED, "camera model %s is not supported, undistort the images first",
                                kinds[kind].name);
    return ADCGS_OK;
}

/** Stores a parameter in the lens. */
static void set_param(adcgs_lens *lens, int param, double value)
{
    switch (param) {
    case BOTH:
        lens->fx = lens->fy = value;
        break;
    case FX:
        lens->fx = value;
        break;
    case FY:
        lens->fy = value;
        break;
    case CX:
        lens->cx = value;
        break;
    case CY:
        lens->cy = value;
        break;
    case P1:
    case P2:
        lens->p[param - P1] = value;
        break;
    default:
        lens->k[param < P1 ? param - K1 : 2 + param - K3] = value;
    }
}

/**
 * Makes room for one more element in an array that grows by doubling. NULL on allocation failure; the array is unchanged then.
 */
static void *grow_array(void *array, size_t n, size_t element)
{
    return n & (n - 1) ? array : realloc(array, (n ? 2 * n : 1) * element);
}

adcgs_status adcgs_colmap_add_camera(adcgs_colmap *model, uint32_t id, int kind, uint64_t width, uint64_t height,
                                     const double *params)
{
    adcgs_colmap_camera camera = {.id = id};
    if (width < 1 || width > ADCGS_IMAGE_MAX || height < 1 || height > ADCGS_IMAGE_MAX)
        return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "%llux%llu pixels, expected 1 to %d", (unsigned long long)width,
                                (unsigned long long)height, ADCGS_IMAGE_MAX);
    camera.lens.width = (int32_t)width;
    camera.lens.height = (int32_t)height;
    camera.lens.is_fisheye = kinds[kind].is_fisheye;
    for (int i = 0; i < kinds[kind].n; i++) {
        if (!(fabs(params[i]) <= WORLD_MAX))
            return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "parameter %d of %s is %g", i + 1, kinds[kind].name, params[i]);
        set_param(&camera.lens, kinds[kind].params[i], params[i]);
    }
    if (!(camera.lens.fx >= 1e-3 && camera.lens.fy >= 1e-3))
        return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "focal lengths %g and %g, expected at least 0.001 pixels", camera.lens.fx,
                                camera.lens.fy);
    adcgs_colmap_camera *cameras = grow_array(model->cameras, model->n_cameras, sizeof *cameras);
    if (!cameras)
        return adcgs_colmap_bad(model, ADCGS_ERR_MEMORY, "out of memory");
    model->cameras = cameras;
    cameras[model->n_cameras++] = camera;
    return ADCGS_OK;
}

static int compare_cameras(const void *a, const void *b)
{
    const uint32_t x = ((const adcgs_colmap_camera *)a)->id, y = ((const adcgs_colmap_camera *)b)->id;
    return (x > y) - (x < y);
}

adcgs_status adcgs_colmap_sort_cameras(adcgs_colmap *model)
{
    if (model->n_cameras)
        qsort(model->cameras, model->n_cameras, sizeof *model->cameras, compare_cameras);
    for (size_t i = 1; i < model->n_cameras; i++)
        if (model->cameras[i].id == model->cameras[i - 1].id)
            return adcgs_fail(model->error, ADCGS_ERR_DATA, "%s: camera %u is listed twice", model->path, model->cameras[i].id);
    return ADCGS_OK;
}

const adcgs_colmap_camera *adcgs_colmap_find_camera(const adcgs_colmap *model, uint32_t id)
{
    const adcgs_colmap_camera key = {.id = id};
    return model->n_cameras ? bsearch(&key, model->cameras, model->n_cameras, sizeof key, compare_cameras) : NULL;
}

/* ---- Images ---- */

/** Computes the camera-to-world pose from the world-to-camera pose: R^T, -R^T t. Returns 0 if it is invalid. */
static int invert_pose(const double q[4], const double t[3], double pose[12])
{
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length >= 1e-6 && length <= WORLD_MAX))
        return 0;
    double r[9];
    adcgs_quaternion_matrix((const double[]){q[0] / length, q[1] / length, q[2] / length, q[3] / length}, r);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            pose[4 * i + j] = r[3 * j + i];
        pose[4 * i + 3] = -(r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
        if (!(fabs(pose[4 * i + 3]) <= WORLD_MAX))
            return 0;
    }
    return 1;
}

/** True for a file below a folder, with a name of plausible length. */
static int is_plain_name(const char *name)
{
    if (!*name || *name == '/' || strlen(name) > NAME_BYTES_MAX)
        return 0;
    for (const char *part = name; part; part = strchr(part, '/')) {
        part += *part == '/';
        if (!strncmp(part, "..", 2) && (part[2] == '/' || !part[2]))
            return 0;
    }
    return 1;
}

adcgs_status adcgs_colmap_add_image(adcgs_colmap *model, uint32_t id, const double q[4], const double t[3], uint32_t camera_id,
                                    const char *name)
{
    adcgs_colmap_image image = {.id = id, .camera_id = camera_id};
    while (name[0] == '.' && name[1] == '/')
        name += 2;
    if (!is_plain_name(name))
        return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "expected the name of an image below the folder, not \"%.64s\"", name);
    if (!invert_pose(q, t, image.cam_to_world))
        return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "%.64s: the pose is no rotation and translation of finite numbers", name);
    adcgs_colmap_image *images = grow_array(model->images, model->n_images, sizeof *images);
    if (images)
        model->images = images;
    if (!images || !(image.name = strdup(name)))
        return adcgs_colmap_bad(model, ADCGS_ERR_MEMORY, "out of memory");
    images[model->n_images++] = image;
    return ADCGS_OK;
}

static int compare_images(const void *a, const void *b)
{
    return strcmp(((const adcgs_colmap_image *)a)->name, ((const adcgs_colmap_image *)b)->name);
}

adcgs_status adcgs_colmap_sort_images(adcgs_colmap *model)
{
    if (model->n_images)
        qsort(model->images, model->n_images, sizeof *model->images, compare_images);
    for (size_t i = 1; i < model->n_images; i++)
        if (!strcmp(model->images[i].name, model->images[i - 1].name))
            return adcgs_fail(model->error, ADCGS_ERR_DATA, "%s: %.100s is listed twice", model->path, model->images[i].name);
    return ADCGS_OK;
}

/* ---- Points ---- */

static int compare_ids(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

adcgs_status adcgs_colmap_list_training(adcgs_colmap *model, size_t n, size_t period)
{
    const size_t all = model->n_images ? model->n_images : n;
    model->training = malloc((all + 1) * sizeof *model->training);
    if (!model->training)
        return adcgs_fail(model->error, ADCGS_ERR_MEMORY, "out of memory for %zu images", all);
    for (size_t i = 0; i < all; i++)
        if (i % period)
            model->training[model->n_training++] = model->n_images ? model->images[i].id : (uint32_t)(i + 1);
    qsort(model->training, model->n_training, sizeof *model->training, compare_ids);
    return ADCGS_OK;
}

int adcgs_colmap_is_training(const adcgs_colmap *model, uint32_t image)
{
    return model->n_training && bsearch(&image, model->training, model->n_training, sizeof image, compare_ids);
}

void adcgs_colmap_add_seen(const adcgs_colmap *model, const double position[3], uint32_t image, adcgs_colmap_track *track)
{
    track->training += (uint64_t)adcgs_colmap_is_training(model, image);
    if (model->angles)
        adcgs_colmap_angles_see(model->angles, position, image);
}

adcgs_status adcgs_colmap_add_point(adcgs_colmap *model, const double position[3], const uint64_t colour[3],
                                    const adcgs_colmap_track *track)
{
    for (int a = 0; a < 3; a++) {
        if (!(fabs(position[a]) <= WORLD_MAX))
            return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "%c is %g, expected at most %g", "xyz"[a], position[a], WORLD_MAX);
        if (colour[a] > 255)
            return adcgs_colmap_bad(model, ADCGS_ERR_DATA, "a colour is %llu, expected at most 255",
                                    (unsigned long long)colour[a]);
    }
    if (track->seen) {
        model->tracked++;
        model->seen += track->seen;
        model->deviation += track->deviation;
    }
    if (model->angles)
        adcgs_colmap_angles_end_point(model->angles);
    if (model->angles && model->angles->failed)
        return adcgs_colmap_bad(model, ADCGS_ERR_MEMORY, "out of memory for angles");
    if (model->training && track->seen && track->training < 2)
        return ADCGS_OK;
    for (int a = 0; a < 3; a++) {
        model->points.position[model->points.n][a] = position[a];
        model->points.colour[model->points.n][a] = (uint8_t)colour[a];
    }
    model->points.n++;
    return ADCGS_OK;
}
