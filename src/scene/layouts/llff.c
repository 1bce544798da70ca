/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The layouts of LLFF and Neu3D. */
#include "config.h"

#include "scene/layouts/llff.h"

#include "media/arrays/npy.h"
#include "media/video/video.h"
#include "scene/layouts/calibration.h"
#include "scene/layouts/colmap.h"
#include "scene/layouts/footage.h"
#include "media/listing.h"
#include "scene/pose_check.h"
#include "system/file.h"
#include "system/paths.h"
#include "system/text.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define COLUMNS 17                                           /* numbers of a row; definition of poses_bounds.npy */
#define POSES_MAX 100000                                     /* rows */
#define FILE_MAX ((uint64_t)POSES_MAX * COLUMNS * 8 + 65536) /* bytes: binary64, and a header */
#define WORLD_MAX 1e9                                        /* largest absolute value of a coordinate, and largest depth */
#define TEST_EVERY 8                                         /* images: one of them is for testing; literature: NeRF, 2020 */
#define DIVIDE_MAX 64                                        /* largest N of images_N */

typedef struct reader {
    adcgs_scene *scene;
    adcgs_error *error;
    const adcgs_frame_range *frames;
    char *path; /**< of the poses */
    uint8_t *data;
    adcgs_npy table;
    adcgs_listing cameras; /**< images of LLFF, videos or folders of Neu3D */
    int fixed;             /**< it is Neu3D */
} reader;

static adcgs_status no_memory(const reader *r)
{
    return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
}

int adcgs_is_llff(const char *folder)
{
    return adcgs_is_there_at("%s/poses_bounds.npy", folder);
}

/* ---- Poses ---- */

static adcgs_status bad_row(const reader *r, size_t row, const char *what)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: row %zu: %s", r->path, row, what);
}

static adcgs_status load_table(reader *r)
{
    size_t bytes;
    if (!r->path)
        return no_memory(r);
    ADCGS_TRY(adcgs_file_load(&r->data, &bytes, r->path, FILE_MAX, r->error));
    ADCGS_TRY(adcgs_npy_open(&r->table, r->data, bytes, COLUMNS, "poses", r->path, r->error));
    if (r->table.rows < 1 || r->table.rows > POSES_MAX)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %llu poses, expected 1 to %d", r->path,
                          (unsigned long long)r->table.rows, POSES_MAX);
    return ADCGS_OK;
}

/** The axes right, down and forward are the columns of an OpenCV pose: the second column, the first, and the negative third. */
static adcgs_status read_pose(const reader *r, size_t row, double pose[12])
{
    for (uint32_t i = 0; i < 3; i++) {
        pose[4 * i] = adcgs_npy_value(&r->table, row, 5 * i + 1);
        pose[4 * i + 1] = adcgs_npy_value(&r->table, row, 5 * i);
        pose[4 * i + 2] = -adcgs_npy_value(&r->table, row, 5 * i + 2);
        pose[4 * i + 3] = adcgs_npy_value(&r->table, row, 5 * i + 3);
        if (!(fabs(pose[4 * i + 3]) <= WORLD_MAX))
            return bad_row(r, row, "the position is not a finite number, or too large");
    }
    char text[128];
    const char *wrong = adcgs_pose_check(pose);
    if (!wrong)
        return ADCGS_OK;
    snprintf(text, sizeof text, "the matrix %s", wrong);
    return bad_row(r, row, text);
}

/** Reads a row's camera for images of this size; file is an image or video of that size. */
static adcgs_status read_view(const reader *r, size_t row, int width, int height, const char *file, adcgs_scene_view *view)
{
    const double h = adcgs_npy_value(&r->table, row, 4), w = adcgs_npy_value(&r->table, row, 9);
    const double f = adcgs_npy_value(&r->table, row, 14);
    *view = (adcgs_scene_view){.time = 0.0};
    ADCGS_TRY(read_pose(r, row, view->camera.cam_to_world));
    if (!(h >= 1.0 && h <= 1e6 && w >= 1.0 && w <= 1e6) || h != floor(h) || w != floor(w))
        return bad_row(r, row, "height and width: expected whole numbers of pixels");
    if (!(f >= 1e-3 && f <= 1e9))
        return bad_row(r, row, "the focal length is not within 0.001 and 1e9");
    const adcgs_lens lens = {.width = (int32_t)w, .height = (int32_t)h, .fx = f, .fy = f, .cx = 0.5 * w, .cy = 0.5 * h};
    adcgs_stem(view->camera.name, sizeof view->camera.name, r->cameras.names[row]);
    return adcgs_calibrate(view, &lens, width, height, file, r->error);
}

/** Checks the bounds of every row; those of training views set the scene's near bound. */
static adcgs_status read_bounds(const reader *r, size_t row, adcgs_split split)
{
    const double near = adcgs_npy_value(&r->table, row, 15), far = adcgs_npy_value(&r->table, row, 16);
    if (!(near > 0.0 && near < far && far <= WORLD_MAX)) {
        char text[128];
        snprintf(text, sizeof text, "bounds of depth %g and %g, expected 0 < near < far <= %g", near, far, WORLD_MAX);
        return bad_row(r, row, text);
    }
    if (split != ADCGS_SPLIT_TRAIN)
        return ADCGS_OK;
    double *bound = &r->scene->near_bound;
    *bound = *bound > 0.0 ? fmin(*bound, near) : near;
    return ADCGS_OK;
}

static adcgs_status check_count(const reader *r, const char *what)
{
    if (r->cameras.n == r->table.rows)
        return ADCGS_OK;
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %llu pose%s, but there are %zu %s", r->path,
                      (unsigned long long)r->table.rows, adcgs_s(r->table.rows), r->cameras.n, what);
}

/* ---- Images of one time ---- */

/** *path: images, or the images_N of the largest images, from malloc(); NULL if there is none. */
static adcgs_status find_images(const reader *r, char **path)
{
    *path = NULL;
    for (int n = 1; n <= DIVIDE_MAX; n++) {
        *path = n == 1 ? adcgs_path("%s/images", r->scene->directory) : adcgs_path("%s/images_%d", r->scene->directory, n);
        if (!*path)
            return no_memory(r);
        if (adcgs_is_folder(*path))
            return ADCGS_OK;
        free(*path);
        *path = NULL;
    }
    return ADCGS_OK;
}

static adcgs_status add_pictures(const reader *r, const char *folder)
{
    const size_t n = r->cameras.n, sized = n > 1 ? 1 : 0; /* the first training image determines the size */
    int width, height, channels;
    char *path = adcgs_path("%s/%s", folder, r->cameras.names[sized]);
    adcgs_status status = path ? adcgs_image_probe(&width, &height, &channels, path, r->error) : no_memory(r);
    for (size_t i = 0; status == ADCGS_OK && i < n; i++) {
        const adcgs_split split = i % TEST_EVERY == 0 ? ADCGS_SPLIT_TEST : ADCGS_SPLIT_TRAIN;
        adcgs_scene_view view;
        status = read_view(r, i, width, height, path, &view);
        if (status == ADCGS_OK)
            status = read_bounds(r, i, split);
        if (status == ADCGS_OK && !(view.path = adcgs_path("%s/%s", folder, r->cameras.names[i])))
            status = no_memory(r);
        if (status == ADCGS_OK)
            status = adcgs_scene_append(r->scene, split, &view, r->path, r->error);
    }
    free(path);
    return status;
}

static adcgs_status read_still(reader *r)
{
    char *folder;
    ADCGS_TRY(find_images(r, &folder));
    if (!folder)
        return adcgs_fail(r->error, ADCGS_ERR_DATA,
                          "%s: neither videos cam00.mp4, ... nor folders cam00, ... nor a folder images or images_N",
                          r->scene->directory);
    adcgs_status status = adcgs_listing_read(&r->cameras, folder, adcgs_is_image_name, r->error);
    if (status == ADCGS_OK)
        status = check_count(r, "images");
    if (status == ADCGS_OK)
        status = add_pictures(r, folder);
    free(folder);
    ADCGS_TRY(status);
    return adcgs_frames_keep(r->scene, r->frames, r->scene->directory, r->error);
}

/* ---- Fixed cameras ---- */

/** Skips camNN and returns the rest; NULL for other names. */
static const char *skip_camera(const char *name)
{
    if (strncmp(name, "cam", 3) || name[3] < '0' || name[3] > '9')
        return NULL;
    for (name += 3; *name >= '0' && *name <= '9';)
        name++;
    return name;
}

static int is_camera_video(const char *name)
{
    const char *end = skip_camera(name);
    return end && *end == '.' && adcgs_is_video(name);
}

static int is_camera_folder(const char *name)
{
    const char *end = skip_camera(name);
    return end && !*end;
}

static adcgs_status open_footage(const reader *r, size_t index, int videos, adcgs_footage *footage)
{
    char *path = adcgs_path("%s/%s", r->scene->directory, r->cameras.names[index]);
    char *images = adcgs_path("%s/%s/images", r->scene->directory, r->cameras.names[index]);
    const char *folder = adcgs_is_folder(images) ? images : path;
    const adcgs_status status = !path || !images ? no_memory(r)
                                : videos         ? adcgs_footage_video(footage, path, r->error)
                                                 : adcgs_footage_folder(footage, folder, r->error);
    free(path);
    free(images);
    return status;
}

/** Adds the views of one camera; *frames is the number of frames of the first camera. */
static adcgs_status add_camera(const reader *r, size_t index, const adcgs_footage *footage, int64_t *frames)
{
    const adcgs_split split = index ? ADCGS_SPLIT_TRAIN : ADCGS_SPLIT_TEST;
    const char *name = r->cameras.names[index];
    adcgs_scene_view like;
    int64_t count;
    if (index && footage->frames != *frames)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: %s has %lld frame%s, but %s has %lld", r->scene->directory,
                          r->cameras.names[0], (long long)*frames, adcgs_s((uint64_t)*frames), name, (long long)footage->frames);
    *frames = footage->frames;
    ADCGS_TRY(adcgs_frames_count(r->frames, footage->frames, &count, r->scene->directory, r->error));
    const char *file = footage->video ? footage->video : footage->pictures[0];
    ADCGS_TRY(read_view(r, index, footage->width, footage->height, file, &like));
    ADCGS_TRY(read_bounds(r, index, split));
    if (!r->scene->rate.den)
        r->scene->rate = footage->rate;
    return adcgs_footage_add(r->scene, split, &like, footage, r->frames, 0.0, count > 1 ? 1.0 / (double)(count - 1) : 0.0,
                             r->scene->directory, r->error);
}

static adcgs_status read_cameras(reader *r, int videos)
{
    int64_t frames = 0;
    adcgs_status status = check_count(r, videos ? "videos" : "folders of cameras");
    if (status == ADCGS_OK && r->cameras.n < 2)
        status = adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: one camera, which is for testing: none is left for training",
                            r->scene->directory);
    for (size_t i = 0; status == ADCGS_OK && i < r->cameras.n; i++) {
        adcgs_footage footage;
        status = open_footage(r, i, videos, &footage);
        if (status == ADCGS_OK)
            status = add_camera(r, i, &footage, &frames);
        adcgs_footage_clear(&footage);
    }
    return status;
}

/* ---- The scene ---- */

static adcgs_status read_layout(reader *r)
{
    ADCGS_TRY(load_table(r));
    for (int videos = 1; videos >= 0; videos--) {
        ADCGS_TRY(adcgs_listing_read(&r->cameras, r->scene->directory, videos ? is_camera_video : is_camera_folder, r->error));
        r->fixed = r->cameras.n > 0;
        if (r->fixed)
            return read_cameras(r, videos);
    }
    return read_still(r);
}

adcgs_status adcgs_llff_read(adcgs_scene *scene, const adcgs_frame_range *frames, int with_points, adcgs_error *error)
{
    reader r = {.scene = scene, .error = error, .frames = frames, .path = adcgs_path("%s/poses_bounds.npy", scene->directory)};
    adcgs_status status = read_layout(&r);
    if (status == ADCGS_OK && !scene->n_views[ADCGS_SPLIT_TRAIN])
        status = adcgs_fail(error, ADCGS_ERR_DATA, "%s: one image, which is for testing: none is left for training", r.path);
    if (status == ADCGS_OK)
        scene->axes = adcgs_pose_axes(scene->views[ADCGS_SPLIT_TRAIN], scene->n_views[ADCGS_SPLIT_TRAIN]);
    adcgs_listing_free(&r.cameras);
    free(r.data);
    free(r.path);
    ADCGS_TRY(status);
    if (with_points && !adcgs_is_there_at("%s/points3d.ply", scene->directory))
        status = adcgs_colmap_read_points(scene, r.table.rows, r.fixed ? SIZE_MAX : TEST_EVERY, error);
    return status;
}
