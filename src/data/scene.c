/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes: names of their parts, and pictures as training and measuring want them. */
#include "config.h"

#include "data/scene.h"

#include "data/clips.h"
#include "data/splat_views.h"

#include <math.h>
#include <stdlib.h>

static const char *const split_names[ADCGS_SPLITS] = {"train", "val", "test"};

const char *adcgs_split_name(adcgs_split split)
{
    return split_names[split];
}

int adcgs_split_parse(const char *name, adcgs_split *split)
{
    for (int i = 0; i < ADCGS_SPLITS; i++)
        if (!strcmp(name, split_names[i])) {
            *split = (adcgs_split)i;
            return 0;
        }
    return -1;
}

void adcgs_scene_free(adcgs_scene **scene)
{
    if (!*scene)
        return;
    for (int s = 0; s < ADCGS_SPLITS; s++) {
        for (uint32_t i = 0; i < (*scene)->n_views[s]; i++)
            free((*scene)->views[s][i].path);
        free((*scene)->views[s]);
    }
    adcgs_points_free(&(*scene)->points);
    adcgs_splat_scene_free(&(*scene)->splats);
    adcgs_clips_free(&(*scene)->clips);
    free((*scene)->directory);
    free(*scene);
    *scene = NULL;
}

static adcgs_status check_size(const adcgs_scene_view *view, int width, int height, adcgs_error *error)
{
    const int bends = view->lens.width > 0;
    const int wanted[2] = {bends ? view->lens.width : view->camera.width, bends ? view->lens.height : view->camera.height};
    if (width == wanted[0] && height == wanted[1])
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, expected %dx%d as its camera says", view->path, width, height,
                      wanted[0], wanted[1]);
}

adcgs_status adcgs_scene_probe(const adcgs_scene_view *view, adcgs_error *error)
{
    int width, height, channels;
    ADCGS_TRY(adcgs_image_probe(&width, &height, &channels, view->path, error));
    return check_size(view, width, height, error);
}

/** Colour of one pixel over the background. */
static inline void composite(const float *pixel, int channels, const float background[3], float rgb[3])
{
    const float alpha = channels % 2 ? 1.0f : pixel[channels - 1];
    for (int c = 0; c < 3; c++) {
        const float value = pixel[channels < 3 ? 0 : c];
        rgb[c] = channels % 2 ? value : value * alpha + background[c] * (1.0f - alpha);
    }
}

/** Average of the box of source pixels under one pixel of the smaller picture. */
static void average_box(const adcgs_image *image, int x, int y, int divide, const float background[3], float out[3])
{
    const int right = ADCGS_MIN(x + divide, image->width), bottom = ADCGS_MIN(y + divide, image->height);
    float sum[3] = {0.0f, 0.0f, 0.0f}, rgb[3];
    for (int v = y; v < bottom; v++)
        for (int u = x; u < right; u++) {
            const size_t pixel = (size_t)v * (size_t)image->width + (size_t)u;
            composite(image->data + pixel * (size_t)image->channels, image->channels, background, rgb);
            for (int c = 0; c < 3; c++)
                sum[c] += rgb[c];
        }
    const float scale = 1.0f / (float)((right - x) * (bottom - y));
    for (int c = 0; c < 3; c++)
        out[c] = divide == 1 ? sum[c] : sum[c] * scale;
}

static float *reduce(const adcgs_image *image, int divide, const float background[3])
{
    const int width = (image->width + divide - 1) / divide, height = (image->height + divide - 1) / divide;
    const size_t plane = (size_t)width * (size_t)height;
    float *rgb = malloc(3 * plane * sizeof *rgb);
    for (int y = 0; rgb && y < height; y++)
        for (int x = 0; x < width; x++) {
            float colour[3];
            average_box(image, x * divide, y * divide, divide, background, colour);
            for (size_t c = 0; c < 3; c++)
                rgb[c * plane + (size_t)y * (size_t)width + (size_t)x] = colour[c];
        }
    return rgb;
}

static void divide_camera(adcgs_camera *camera, int divide)
{
    camera->width = (camera->width + divide - 1) / divide;
    camera->height = (camera->height + divide - 1) / divide;
    camera->fx /= divide;
    camera->fy /= divide;
    camera->cx /= divide;
    camera->cy /= divide;
}

/** Of another size than it should have, an image is refused before there is memory for its pixels. */
static adcgs_status read_image(const adcgs_scene_view *view, adcgs_image *image, adcgs_error *error)
{
    ADCGS_TRY(adcgs_scene_probe(view, error));
    return adcgs_image_read(image, view->path, error);
}

/** As it was taken: of a file, a video or splats. */
static adcgs_status read_picture(const adcgs_scene *scene, const adcgs_scene_view *view, adcgs_image *image, adcgs_error *error)
{
    if (scene->splats)
        return adcgs_splat_scene_render(scene->splats, scene->background, &view->camera, image, view->path, error);
    return view->is_video ? adcgs_clips_read(scene->clips, view->path, view->frame, image, error)
                          : read_image(view, image, error);
}

adcgs_status adcgs_scene_load(const adcgs_scene *scene, const adcgs_scene_view *view, int divide, float **rgb,
                              adcgs_camera *camera, adcgs_error *error)
{
    adcgs_image image;
    *rgb = NULL;
    if (divide < 1)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%s: cannot reduce by %d", view->path, divide);
    ADCGS_TRY(read_picture(scene, view, &image, error));
    adcgs_status status = check_size(view, image.width, image.height, error);
    if (status == ADCGS_OK && view->lens.width > 0)
        status = adcgs_lens_straighten(&view->lens, &view->camera, &image, view->path, error);
    if (status == ADCGS_OK && !(*rgb = reduce(&image, divide, scene->background)))
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", view->path);
    adcgs_image_free(&image);
    if (status == ADCGS_OK && camera) {
        *camera = view->camera;
        divide_camera(camera, divide);
    }
    return status;
}
