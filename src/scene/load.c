/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Loads images for training and measuring, from files, videos or splats, or from those that the scene keeps. An image file
 * without mask and lens is reduced row by row during reading, to the same values as a whole image. A large image is never in
 * memory whole as binary32.
 */
#include "config.h"

#include "scene/scene.h"

#include "scene/clips.h"
#include "scene/image_cache.h"
#include "scene/image_shape.h"
#include "scene/splat_views.h"
#include "scene/view_mask.h"

#include <stdlib.h>

static adcgs_status check_size(const adcgs_scene_view *view, const char *path, int width, int height, adcgs_error *error)
{
    int wanted[2];
    adcgs_view_size(view, wanted);
    if (width == wanted[0] && height == wanted[1])
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected %dx%d as its camera says", path, width, height,
                      wanted[0], wanted[1]);
}

/** Refuses an image of the wrong size before memory for its pixels is allocated. */
static adcgs_status probe(const adcgs_scene_view *view, const char *path, adcgs_error *error)
{
    int width, height, channels;
    ADCGS_TRY(adcgs_image_probe(&width, &height, &channels, path, error));
    return check_size(view, path, width, height, error);
}

adcgs_status adcgs_scene_probe(const adcgs_scene_view *view, adcgs_error *error)
{
    ADCGS_TRY(probe(view, view->path, error));
    if (view->mask)
        ADCGS_TRY(adcgs_view_mask_probe(view, view->mask, error));
    return view->moving ? adcgs_view_mask_probe(view, view->moving, error) : ADCGS_OK;
}

/* ---- Decoding ---- */

/** An image of a view: its own, or its mask. */
typedef struct wanted {
    const adcgs_scene *scene;
    const adcgs_scene_view *view;
    int is_mask;
} wanted;

static adcgs_status decode_whole(const adcgs_scene *scene, const adcgs_scene_view *view, adcgs_image *image, adcgs_error *error)
{
    if (scene->splats)
        return adcgs_splat_scene_render(scene->splats, scene->background, &view->camera, view->source_time, image, view->path,
                                        error);
    if (!view->is_video)
        ADCGS_TRY(probe(view, view->path, error));
    ADCGS_TRY(view->is_video ? adcgs_clips_read(scene->clips, view->path, view->frame, image, error)
                             : adcgs_image_read(image, view->path, error));
    adcgs_image_cache_count(scene->images);
    const adcgs_status status = check_size(view, view->path, image->width, image->height, error);
    if (status != ADCGS_OK)
        adcgs_image_free(image);
    return status;
}

/** Rows of a file, or of a kept image. */
typedef struct rows {
    adcgs_image_rows *file;
    const adcgs_packed_image *kept;
    const char *path;
    int width, height, channels, done;
} rows;

static adcgs_status open_rows(rows *r, const wanted *w, const adcgs_packed_image *kept, adcgs_error *error)
{
    *r = (rows){.kept = kept, .path = w->is_mask ? w->view->mask : w->view->path};
    if (kept) {
        r->width = kept->width;
        r->height = kept->height;
        r->channels = kept->channels;
        return check_size(w->view, r->path, r->width, r->height, error);
    }
    ADCGS_TRY(w->is_mask ? adcgs_view_mask_check(w->view, r->path, error) : probe(w->view, r->path, error));
    ADCGS_TRY(adcgs_image_rows_open(&r->file, &r->width, &r->height, &r->channels, r->path, error));
    adcgs_image_cache_count(w->scene->images);
    const adcgs_status status = w->is_mask ? ADCGS_OK : check_size(w->view, r->path, r->width, r->height, error);
    if (status != ADCGS_OK)
        adcgs_image_rows_close(&r->file);
    return status;
}

static adcgs_status read_rows(rows *r, int n, float *to, adcgs_error *error)
{
    if (!r->kept)
        return adcgs_image_rows_read(r->file, n, to, r->path, error);
    adcgs_packed_image_rows(r->kept, r->done, n, to);
    r->done += n;
    return ADCGS_OK;
}

static void close_rows(rows *r)
{
    if (r->file)
        adcgs_image_rows_close(&r->file);
}

/* ---- Kept images ---- */

/** Decodes a file for the scene to keep. */
static adcgs_status pack_file(void *user, adcgs_packed_image *packed, adcgs_error *error)
{
    rows r;
    ADCGS_TRY(open_rows(&r, user, NULL, error));
    float *const row = malloc((size_t)r.width * (size_t)r.channels * sizeof *row);
    adcgs_status status = row ? adcgs_packed_image_init(packed, r.width, r.height, r.channels, r.path, error)
                              : adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", r.path);
    for (int y = 0; y < r.height && status == ADCGS_OK; y++) {
        status = read_rows(&r, 1, row, error);
        if (status == ADCGS_OK)
            status = adcgs_packed_image_append(packed, row, 1, r.path, error);
    }
    free(row);
    close_rows(&r);
    return status;
}

/** Decodes a frame of a video for the scene to keep. */
static adcgs_status pack_frame(void *user, adcgs_packed_image *packed, adcgs_error *error)
{
    const wanted *const w = user;
    adcgs_image image;
    ADCGS_TRY(decode_whole(w->scene, w->view, &image, error));
    adcgs_status status = adcgs_packed_image_init(packed, image.width, image.height, image.channels, w->view->path, error);
    if (status == ADCGS_OK)
        status = adcgs_packed_image_append(packed, image.data, image.height, w->view->path, error);
    adcgs_image_free(&image);
    return status;
}

/** Takes an image that the scene keeps, or is to keep; NULL: it does not. */
static adcgs_status take_kept(wanted *w, const adcgs_packed_image **kept, adcgs_error *error)
{
    const adcgs_scene_view *const view = w->view;
    const int is_frame = view->is_video && !w->is_mask;
    const int channels = w->is_mask ? 1 : w->scene->has_alpha ? 4 : 3;
    int size[2];
    *kept = NULL;
    if (!w->scene->images || w->scene->splats)
        return ADCGS_OK;
    adcgs_view_size(view, size);
    const uint64_t samples = (uint64_t)channels * (uint64_t)size[0] * (uint64_t)size[1];
    /* Colours of a video are computed, and fit no smaller number. */
    return adcgs_image_cache_take(w->scene->images, kept, w->is_mask ? view->mask : view->path, is_frame ? view->frame : -1,
                                  is_frame ? samples * sizeof(float) : samples, is_frame ? pack_frame : pack_file, w, error);
}

static void give_kept(const adcgs_scene *scene, const adcgs_packed_image *kept)
{
    if (kept)
        adcgs_image_cache_give(scene->images, kept);
}

static adcgs_status copy_kept(adcgs_image *image, const adcgs_packed_image *kept, const char *path, adcgs_error *error)
{
    ADCGS_TRY(adcgs_image_alloc(image, kept->width, kept->height, kept->channels, path, error));
    adcgs_packed_image_rows(kept, 0, kept->height, image->data);
    return ADCGS_OK;
}

/* ---- Loading ---- */

/** Reduces an image while its rows are read, with memory for some rows in addition to the result. */
static adcgs_status load_by_rows(wanted *w, const adcgs_packed_image *kept, int divide, float **rgb, adcgs_error *error)
{
    rows r;
    adcgs_image strip = {.data = NULL};
    const adcgs_image_source s = {&strip, NULL, w->scene->background};
    ADCGS_TRY(open_rows(&r, w, kept, error));
    const size_t across = (size_t)((r.width + divide - 1) / divide), plane = across * (size_t)((r.height + divide - 1) / divide);
    adcgs_status status = adcgs_image_alloc(&strip, r.width, ADCGS_MIN(divide, r.height), r.channels, r.path, error);
    if (status == ADCGS_OK && !(*rgb = malloc(3 * plane * sizeof **rgb)))
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %dx%d pixels", r.path, r.width, r.height);
    for (int y = 0; y < r.height && status == ADCGS_OK; y += divide) {
        strip.height = ADCGS_MIN(divide, r.height - y);
        status = read_rows(&r, strip.height, strip.data, error);
        if (status == ADCGS_OK)
            adcgs_image_place_rows(*rgb, plane, (size_t)(y / divide) * across, &s, divide);
    }
    close_rows(&r);
    adcgs_image_free(&strip);
    if (status != ADCGS_OK) {
        free(*rgb);
        *rgb = NULL;
    }
    return status;
}

static adcgs_status read_mask(const wanted *w, adcgs_image *mask, adcgs_error *error)
{
    wanted hides = {w->scene, w->view, 1};
    const adcgs_packed_image *kept;
    ADCGS_TRY(take_kept(&hides, &kept, error));
    if (!kept) {
        adcgs_image_cache_count(w->scene->images);
        return adcgs_view_mask_read(w->view, w->view->mask, mask, error);
    }
    adcgs_status status = adcgs_view_mask_fits(w->view, w->view->mask, kept->width, kept->height, error);
    if (status == ADCGS_OK)
        status = copy_kept(mask, kept, w->view->mask, error);
    give_kept(w->scene, kept);
    return status == ADCGS_OK ? adcgs_view_mask_settle(w->view, w->view->mask, mask, error) : status;
}

/** Loads the image as a whole, from a file, a video or splats, with its mask and its lens. */
static adcgs_status load_whole(wanted *w, const adcgs_packed_image *kept, int divide, float **rgb, adcgs_error *error)
{
    const adcgs_scene_view *const view = w->view;
    adcgs_image image, mask = {.data = NULL};
    if (kept)
        ADCGS_TRY(check_size(view, view->path, kept->width, kept->height, error));
    ADCGS_TRY(kept ? copy_kept(&image, kept, view->path, error) : decode_whole(w->scene, view, &image, error));
    adcgs_status status = view->mask ? read_mask(w, &mask, error) : ADCGS_OK;
    if (status == ADCGS_OK)
        status = adcgs_image_shape(w->scene, view, view->mask ? &mask : NULL, divide, &image, error);
    if (status == ADCGS_OK && !(*rgb = adcgs_image_planes(&image)))
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", view->path);
    adcgs_image_free(&image);
    adcgs_image_free(&mask);
    return status;
}

static int has_stops(const adcgs_scene_view *view)
{
    return view->stops[0] != 0.0f || view->stops[1] != 0.0f || view->stops[2] != 0.0f;
}

adcgs_status adcgs_scene_image(const adcgs_scene *scene, const adcgs_scene_view *view, int divide, float **rgb,
                               adcgs_camera *camera, adcgs_error *error)
{
    wanted w = {scene, view, 0};
    adcgs_camera seen = view->camera;
    const adcgs_packed_image *kept;
    *rgb = NULL;
    if (divide < 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: cannot reduce by %d", view->path, divide);
    adcgs_camera_divide(&seen, divide);
    ADCGS_TRY(take_kept(&w, &kept, error));
    const int by_rows = !scene->splats && (kept || !view->is_video) && !view->mask && view->lens.width <= 0;
    const adcgs_status status = by_rows ? load_by_rows(&w, kept, divide, rgb, error) : load_whole(&w, kept, divide, rgb, error);
    give_kept(scene, kept);
    ADCGS_TRY(status);
    if (has_stops(view))
        adcgs_image_even_light(view, *rgb, (size_t)seen.width * (size_t)seen.height);
    if (camera)
        *camera = seen;
    return ADCGS_OK;
}

adcgs_status adcgs_scene_borrow(const adcgs_scene *scene, const adcgs_scene_view *view, int divide,
                                const adcgs_packed_image **out, adcgs_error *error)
{
    wanted w = {scene, view, 0};
    *out = NULL;
    if (divide != 1 || view->mask || view->lens.width > 0 || has_stops(view) || view->is_video || scene->has_alpha)
        return ADCGS_OK;
    ADCGS_TRY(take_kept(&w, out, error));
    if (!*out)
        return ADCGS_OK;
    const adcgs_status status = check_size(view, view->path, (*out)->width, (*out)->height, error);
    if (status == ADCGS_OK && (*out)->channels == 3 && (*out)->bytes <= 2)
        return ADCGS_OK;
    give_kept(scene, *out);
    *out = NULL;
    return status;
}

void adcgs_scene_give_back(const adcgs_scene *scene, const adcgs_packed_image *image)
{
    give_kept(scene, image);
}
