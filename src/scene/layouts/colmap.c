/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sparse models of COLMAP as scenes. */
#include "config.h"

#include "scene/layouts/colmap.h"

#include "scene/layouts/calibration.h"
#include "scene/layouts/colmap_files.h"
#include "scene/layouts/colmap_twice.h"
#include "scene/layouts/footage.h"
#include "media/listing.h"
#include "scene/layouts/unmasked.h"
#include "scene/layouts/unposed.h"
#include "scene/pose_check.h"
#include "system/paths.h"
#include "system/text.h"

#include <stdio.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define TEST_EVERY 8  /* images: one of them is for testing; literature: NeRF, 2020 */
#define DIVIDE_MAX 64 /* largest N of images_N and rgb/Nx */

typedef struct reader {
    adcgs_scene *scene;
    adcgs_error *error;
    const adcgs_frame_range *frames;
    adcgs_colmap_models models;
    adcgs_colmap_place place; /**< of the model in use, one of models */
    adcgs_colmap model;
    char *pictures;               /**< folder of the images, with its slash */
    adcgs_scene_view *calibrated; /**< one for each camera; height 0: not yet calibrated */
} reader;

static adcgs_status no_memory(const reader *r)
{
    return adcgs_fail(r->error, ADCGS_ERR_MEMORY, "%s: out of memory", r->scene->directory);
}

/* ---- The files ---- */

static adcgs_status read_file(reader *r, adcgs_colmap_file file)
{
    return adcgs_colmap_load(&r->model, &r->place, file, r->error);
}

/** Like adcgs_fail(), with the file's name in front of the message. */
static adcgs_status bad_file(const reader *r, adcgs_colmap_file file, const char *what)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s%s.%s: %s", r->place.folder,
                      file == ADCGS_COLMAP_CAMERAS ? "cameras" : "images", adcgs_colmap_end(&r->place, file), what);
}

static adcgs_status read_points(reader *r, size_t n, size_t period)
{
    ADCGS_TRY(adcgs_colmap_list_training(&r->model, n, period));
    ADCGS_TRY(read_file(r, ADCGS_COLMAP_POINTS));
    r->scene->points = r->model.points;
    r->model.points = (adcgs_points){0};
    return ADCGS_OK;
}

/* ---- Images ---- */

/**
 * Finds an image in a folder: by its name, with another extension, or in another letter case. *out is NULL if there is none.
 */
static adcgs_status find_in(const reader *r, const char *folder, const char *name, char **out)
{
    char *path = adcgs_path("%s%s", folder, name);
    adcgs_status status = path ? adcgs_find_image(out, path, r->error) : no_memory(r);
    for (char *c = path ? path + strlen(folder) : NULL; status == ADCGS_OK && !*out && c && (c = strchr(c, '\\'));)
        *c = '/'; /* folders separated as in Windows */
    if (status == ADCGS_OK && !*out && strchr(name, '\\'))
        status = adcgs_find_image(out, path, r->error);
    if (status == ADCGS_OK && !*out) {
        char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
        if (dot && (!slash || dot > slash + 1)) {
            *dot = 0;
            status = adcgs_find_image(out, path, r->error);
            *dot = '.';
        }
    }
    if (status == ADCGS_OK && !*out)
        status = adcgs_find_image_like(out, folder, path + strlen(folder), r->error);
    free(path);
    return status;
}

/** If an image is in this folder, the folder becomes that of all images. folder is from malloc() and ends with its slash. */
static adcgs_status try_folder(reader *r, char *folder, const char *name)
{
    char *found = NULL;
    const adcgs_status status = folder ? find_in(r, folder, name, &found) : no_memory(r);
    if (found)
        r->pictures = folder;
    else
        free(folder);
    free(found);
    return status;
}

/** Searches for the folder of an image. */
static adcgs_status look_for(reader *r, const char *name)
{
    static const char *const whole[] = {"images/", "", "input/", "rgb/1x/"};
    const char *directory = r->scene->directory;
    for (size_t i = 0; !r->pictures && i < ADCGS_COUNTOF(whole); i++)
        ADCGS_TRY(try_folder(r, adcgs_path("%s/%s", directory, whole[i]), name));
    for (int n = 2; !r->pictures && n <= DIVIDE_MAX; n++) {
        ADCGS_TRY(try_folder(r, adcgs_path("%s/images_%d/", directory, n), name));
        if (!r->pictures)
            ADCGS_TRY(try_folder(r, adcgs_path("%s/rgb/%dx/", directory, n), name));
    }
    return ADCGS_OK;
}

/** Finds the folder of the first image. If that is missing, of the last; then the later error names the first with its folder. */
static adcgs_status find_pictures(reader *r)
{
    const char *first = r->model.images[0].name, *last = r->model.images[r->model.n_images - 1].name;
    ADCGS_TRY(look_for(r, first));
    if (!r->pictures)
        ADCGS_TRY(look_for(r, last));
    return r->pictures ? ADCGS_OK
                       : adcgs_fail(r->error, ADCGS_ERR_DATA,
                                    "%s: no image %.100s in images, here, input, images_N or rgb/Nx, and no video of it",
                                    r->scene->directory, first);
}

/** Sets the name: the file's, without its extension and with its folders. */
static void set_name(adcgs_camera *camera, const char *name)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(name, '.');
    const size_t n = dot && (slash ? dot > slash + 1 : dot > name) ? (size_t)(dot - name) : strlen(name);
    snprintf(camera->name, sizeof camera->name, "%.*s", (int)n, name);
    for (char *c = camera->name; *c; c++)
        *c = *c == '/' || *c == '\\' ? '_' : *c;
}

/** The camera of an image; NULL, with a message, if the model has none. */
static const adcgs_colmap_camera *find_camera(const reader *r, const adcgs_colmap_image *image)
{
    const adcgs_colmap_camera *camera = adcgs_colmap_find_camera(&r->model, image->camera_id);
    if (!camera)
        adcgs_fail(r->error, ADCGS_ERR_DATA, "%simages.%s: %.100s: there is no camera %u", r->place.folder,
                   adcgs_colmap_end(&r->place, ADCGS_COLMAP_IMAGES), image->name, image->camera_id);
    return camera;
}

static void set_pose(adcgs_scene_view *view, const adcgs_colmap_image *image)
{
    memcpy(view->camera.cam_to_world, image->cam_to_world, sizeof image->cam_to_world);
    set_name(&view->camera, image->name);
}

/** Adds a view's mask from masks/, named like the image with or without its extension, if there is one. */
static adcgs_status add_mask(reader *r, const char *name, adcgs_scene_view *view)
{
    char *folder = adcgs_path("%s/masks/", r->scene->directory);
    const adcgs_status status = folder ? find_in(r, folder, name, &view->mask) : no_memory(r);
    free(folder);
    return status;
}

/** The first image of a camera determines the size of all its images. */
static adcgs_status add_picture(reader *r, const adcgs_colmap_image *image, adcgs_split split)
{
    const adcgs_colmap_camera *camera = find_camera(r, image);
    int width, height, channels;
    char *path = NULL;
    if (!camera)
        return ADCGS_ERR_DATA;
    ADCGS_TRY(find_in(r, r->pictures, image->name, &path));
    if (!path)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s%.100s: no such image", r->pictures, image->name);
    adcgs_scene_view *calibrated = &r->calibrated[camera - r->model.cameras];
    adcgs_status status = ADCGS_OK;
    if (!calibrated->camera.height) {
        status = adcgs_image_probe(&width, &height, &channels, path, r->error);
        if (status == ADCGS_OK)
            status = adcgs_calibrate(calibrated, &camera->lens, width, height, path, r->error);
    }
    if (status != ADCGS_OK) {
        free(path);
        return status;
    }
    adcgs_scene_view view = *calibrated;
    set_pose(&view, image);
    view.path = path;
    ADCGS_TRY(adcgs_scene_append(r->scene, split, &view, r->scene->directory, r->error));
    return add_mask(r, image->name, &r->scene->views[split][r->scene->n_views[split] - 1]);
}

static adcgs_status add_pictures(reader *r)
{
    ADCGS_TRY(find_pictures(r));
    for (int split = 0; split < ADCGS_SPLITS; split++) /* training comes first, so that its images determine the size */
        for (size_t i = 0; i < r->model.n_images; i++)
            if (split == (i % TEST_EVERY == 0 ? ADCGS_SPLIT_TEST : ADCGS_SPLIT_TRAIN))
                ADCGS_TRY(add_picture(r, &r->model.images[i], (adcgs_split)split));
    adcgs_counting counting = {.n = 0};
    for (size_t i = 0; i < r->model.n_images; i++) {
        adcgs_camera named;
        set_name(&named, r->model.images[i].name);
        adcgs_counting_add(&counting, named.name);
    }
    r->scene->counts = adcgs_counting_holds(&counting);
    if (strlen(r->pictures) > strlen(r->scene->directory) + 1) /* the scene's own folder may contain unrelated files */
        ADCGS_TRY(adcgs_unposed_remark(r->scene, r->pictures, r->error));
    ADCGS_TRY(adcgs_unmasked_remark(r->scene, "of their name in masks", r->error));
    return adcgs_frames_keep(r->scene, r->frames, r->scene->directory, r->error);
}

/* ---- Videos ---- */

/** The video of a camera, from malloc(); NULL if there is none. */
static char *find_video(const reader *r, const char *name)
{
    static const char *const ends[] = {"mp4", "mkv", "mov", "webm"};
    const char *slash = strrchr(name, '/'), *dot = strrchr(name, '.');
    const int all = (int)strlen(name), stem = dot && (slash ? dot > slash + 1 : dot > name) ? (int)(dot - name) : all;
    for (size_t i = 0; i < ADCGS_COUNTOF(ends); i++)
        for (int way = 0; way < 3; way++) {
            const int length = way ? stem : all;
            char *path = adcgs_path("%s/%s%.*s.%s", r->scene->directory, way < 2 ? "videos/" : "", length, name, ends[i]);
            if (adcgs_is_there(path))
                return path;
            free(path);
        }
    return NULL;
}

/** Adds the views of one camera; *frames is the number of frames of the first camera. */
static adcgs_status add_footage(reader *r, size_t index, const adcgs_footage *footage, int64_t *frames)
{
    const adcgs_colmap_image *image = &r->model.images[index], *first = &r->model.images[0];
    const adcgs_colmap_camera *camera = find_camera(r, image);
    adcgs_scene_view like = {.time = 0.0};
    int64_t count;
    if (!camera)
        return ADCGS_ERR_DATA;
    if (index && footage->frames != *frames)
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: the video of %.100s has %lld frame%s, but that of %.100s has %lld",
                          r->scene->directory, first->name, (long long)*frames, adcgs_s((uint64_t)*frames), image->name,
                          (long long)footage->frames);
    *frames = footage->frames;
    if (!r->scene->rate.den)
        r->scene->rate = footage->rate;
    ADCGS_TRY(adcgs_frames_count(r->frames, footage->frames, &count, r->scene->directory, r->error));
    ADCGS_TRY(adcgs_calibrate(&like, &camera->lens, footage->width, footage->height, footage->video, r->error));
    set_pose(&like, image);
    return adcgs_footage_add(r->scene, index ? ADCGS_SPLIT_TRAIN : ADCGS_SPLIT_TEST, &like, footage, r->frames, 0.0,
                             count > 1 ? 1.0 / (double)(count - 1) : 0.0, r->scene->directory, r->error);
}

static adcgs_status add_videos(reader *r)
{
    int64_t frames = 0;
    adcgs_status status = ADCGS_OK;
    for (size_t i = 0; status == ADCGS_OK && i < r->model.n_images; i++) {
        adcgs_footage footage = {0};
        char *path = find_video(r, r->model.images[i].name);
        status = path ? adcgs_footage_video(&footage, path, r->error)
                      : adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: there is a video of %.100s, but none of %.100s",
                                   r->scene->directory, r->model.images[0].name, r->model.images[i].name);
        if (status == ADCGS_OK)
            status = add_footage(r, i, &footage, &frames);
        adcgs_footage_clear(&footage);
        free(path);
    }
    return status;
}

/* ---- The scene ---- */

/** Reports the choice if there are several models. */
static void remark_models(const reader *r)
{
    const adcgs_colmap_models *m = &r->models;
    if (m->n < 2)
        return;
    const char *taken = m->place.folder + strlen(r->scene->directory) + 1;
    const char *other = m->other.folder + strlen(r->scene->directory) + 1;
    adcgs_scene_remark(r->scene, "found %u models of COLMAP: %.*s with %zu images is used; %.*s has %zu", m->n,
                       *taken ? (int)strlen(taken) - 1 : 9, *taken ? taken : "that here", m->images,
                       *other ? (int)strlen(other) - 1 : 9, *other ? other : "that here", m->other_images);
}

static adcgs_status read_model(reader *r, int with_points)
{
    const adcgs_colmap_file files[] = {ADCGS_COLMAP_CAMERAS, ADCGS_COLMAP_IMAGES, ADCGS_COLMAP_POINTS};
    for (size_t i = 0; i < ADCGS_COUNTOF(files) - !with_points; i++)
        if (!adcgs_colmap_has(&r->place, files[i]))
            return read_file(r, files[i]); /* reports the error */
    ADCGS_TRY(read_file(r, ADCGS_COLMAP_CAMERAS));
    if (!r->model.n_cameras)
        return bad_file(r, ADCGS_COLMAP_CAMERAS, "no cameras, expected at least one");
    ADCGS_TRY(read_file(r, ADCGS_COLMAP_IMAGES));
    if (r->model.n_images < 2)
        return bad_file(r, ADCGS_COLMAP_IMAGES,
                        r->model.n_images ? "1 image, expected at least two: the first is for testing"
                                          : "0 images, expected at least two: the first is for testing");
    if (!(r->calibrated = calloc(r->model.n_cameras + 1, sizeof *r->calibrated)))
        return no_memory(r);
    char *video = find_video(r, r->model.images[0].name);
    const int has_videos = video != NULL;
    free(video);
    remark_models(r);
    for (int f = ADCGS_COLMAP_CAMERAS; f <= ADCGS_COLMAP_IMAGES; f++)
        ADCGS_TRY(adcgs_colmap_twice_remark(r->scene, &r->model, &r->place, (adcgs_colmap_file)f, r->error));
    ADCGS_TRY(has_videos ? add_videos(r) : add_pictures(r));
    r->scene->axes = adcgs_pose_axes(r->scene->views[ADCGS_SPLIT_TRAIN], r->scene->n_views[ADCGS_SPLIT_TRAIN]);
    return with_points ? read_points(r, 0, has_videos ? SIZE_MAX : TEST_EVERY) : ADCGS_OK;
}

static void clear(reader *r)
{
    adcgs_colmap_clear(&r->model);
    free(r->calibrated);
    free(r->pictures);
    adcgs_colmap_forget(&r->models);
}

adcgs_status adcgs_colmap_read(adcgs_scene *scene, const adcgs_frame_range *frames, int with_points, adcgs_error *error)
{
    reader r = {.scene = scene, .error = error, .frames = frames};
    adcgs_status status = adcgs_colmap_find(&r.models, scene->directory, 0, error);
    r.place = r.models.place;
    if (status == ADCGS_OK)
        status = r.place.folder ? read_model(&r, with_points)
                                : adcgs_fail(error, ADCGS_ERR_DATA,
                                             "%s: no COLMAP model: no cameras.bin or cameras.txt in sparse/0, "
                                             "sparse or here",
                                             scene->directory);
    clear(&r);
    return status;
}

adcgs_status adcgs_colmap_read_points(adcgs_scene *scene, size_t n, size_t period, adcgs_error *error)
{
    reader r = {.scene = scene, .error = error};
    adcgs_status status = adcgs_colmap_find(&r.models, scene->directory, 1, error);
    r.place = r.models.place;
    if (r.place.folder && adcgs_colmap_has(&r.place, ADCGS_COLMAP_POINTS)) {
        if (adcgs_colmap_has(&r.place, ADCGS_COLMAP_IMAGES))
            status = read_file(&r, ADCGS_COLMAP_IMAGES);
        if (status == ADCGS_OK)
            status = read_points(&r, n, period);
    }
    clear(&r);
    return status;
}
