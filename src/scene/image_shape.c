/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Shapes of images. If an image needs both undistortion and reduction, most of the reduction comes first: a box filter is cheap,
 * resampling is expensive. The last integer factor follows undistortion, to preserve detail where the lens stretches the image.
 * On a grid twice as fine, interpolation loses next to nothing of the final result.
 */
#include "config.h"

#include "scene/image_shape.h"

#include "scene/view_mask.h"

#include <math.h>
#include <stdlib.h>

/* Least unmasked share of a pixel that counts, and least moving share of a moving pixel; a half, definition. */
#define COUNTS 0.5f

/* ---- Reducing ---- */

/** Colour of one pixel over the background. */
static inline void composite(const float *pixel, int channels, const float background[3], float rgb[3])
{
    const float alpha = channels % 2 ? 1.0f : pixel[channels - 1];
    for (int c = 0; c < 3; c++) {
        const float value = pixel[channels < 3 ? 0 : c];
        rgb[c] = channels % 2 ? value : value * alpha + background[c] * (1.0f - alpha);
    }
}

/** True for any colour except black. */
static inline int is_seen(const adcgs_image *mask, size_t pixel)
{
    const float *values = mask->data + pixel * (size_t)mask->channels;
    const int colours = mask->channels < 3 ? 1 : 3;
    int seen = 0;
    for (int c = 0; c < colours; c++)
        seen |= values[c] > 0.0f;
    return seen;
}

/** Sets colour and weight of a pixel; true if the pixel counts. */
static inline int read_pixel(const adcgs_image_source *s, size_t pixel, float value[4])
{
    const float *from = s->image->data + pixel * (size_t)s->image->channels;
    value[3] = 1.0f;
    if (s->mask && !is_seen(s->mask, pixel))
        return 0;
    if (s->background)
        composite(from, s->image->channels, s->background, value);
    else
        memcpy(value, from, (size_t)s->image->channels * sizeof *value);
    return value[3] > 0.0f;
}

/** Averages the counting source pixels in the box under one pixel of the reduced image; out[3] is their share. */
static void average_box(const adcgs_image_source *s, int x, int y, int divide, float out[4])
{
    const int right = ADCGS_MIN(x + divide, s->image->width), bottom = ADCGS_MIN(y + divide, s->image->height);
    float sum[4] = {0.0f, 0.0f, 0.0f, 0.0f}, value[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    for (int v = y; v < bottom; v++)
        for (int u = x; u < right; u++) {
            if (!read_pixel(s, (size_t)v * (size_t)s->image->width + (size_t)u, value))
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += value[3] * value[c];
            sum[3] += value[3];
        }
    const float scale = sum[3] > 0.0f ? 1.0f / sum[3] : 0.0f;
    for (int c = 0; c < 3; c++)
        out[c] = sum[c] * scale;
    out[3] = sum[3] / (float)((right - x) * (bottom - y));
}

static adcgs_status reduce(adcgs_image *out, const adcgs_image_source *s, int divide, const char *path, adcgs_error *error)
{
    const int width = (s->image->width + divide - 1) / divide, height = (s->image->height + divide - 1) / divide;
    const int channels = s->mask || (!s->background && s->image->channels == 4) ? 4 : 3;
    ADCGS_TRY(adcgs_image_alloc(out, width, height, channels, path, error));
    float *to = out->data;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, to += channels) {
            float value[4];
            average_box(s, x * divide, y * divide, divide, value);
            memcpy(to, value, (size_t)channels * sizeof *to);
        }
    return ADCGS_OK;
}

/** Reduce in place. */
static adcgs_status reduce_image(adcgs_image *image, const adcgs_image_source *s, int divide, const char *path,
                                 adcgs_error *error)
{
    adcgs_image out;
    ADCGS_TRY(reduce(&out, s, divide, path, error));
    adcgs_image_free(image);
    *image = out;
    return ADCGS_OK;
}

/* ---- Straightening ---- */

void adcgs_camera_divide(adcgs_camera *camera, int divide)
{
    camera->width = (camera->width + divide - 1) / divide;
    camera->height = (camera->height + divide - 1) / divide;
    camera->fx /= divide;
    camera->fy /= divide;
    camera->cx /= divide;
    camera->cy /= divide;
}

/** The factor left for after undistortion: the smallest divisor above 1. */
static int last_factor(int divide)
{
    for (int factor = 2; factor * factor <= divide; factor++)
        if (divide % factor == 0)
            return factor;
    return divide;
}

/** The image is already reduced by `divide`. */
static adcgs_status straighten(const adcgs_scene_view *view, adcgs_image *image, int divide, adcgs_error *error)
{
    adcgs_lens lens = view->lens;
    adcgs_camera camera = view->camera;
    adcgs_camera_divide(&camera, divide);
    lens.width = image->width;
    lens.height = image->height;
    lens.fx /= divide;
    lens.fy /= divide;
    lens.cx /= divide;
    lens.cy /= divide;
    lens.skew /= divide;
    return adcgs_lens_straighten(&lens, &camera, image, view->path, error);
}

adcgs_status adcgs_image_shape(const adcgs_scene *scene, const adcgs_scene_view *view, const adcgs_image *mask, int divide,
                               adcgs_image *image, adcgs_error *error)
{
    const int bends = view->lens.width > 0, after = bends ? last_factor(divide) : 1, before = divide / after;
    const adcgs_image_source taken = {image, mask, scene->background}, straight = {image, NULL, NULL};
    if (before > 1 || mask || image->channels != 3)
        ADCGS_TRY(reduce_image(image, &taken, before, view->path, error));
    if (bends)
        ADCGS_TRY(straighten(view, image, before, error));
    return after > 1 ? reduce_image(image, &straight, after, view->path, error) : ADCGS_OK;
}

float *adcgs_image_planes(const adcgs_image *image)
{
    const size_t plane = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    float *rgb = malloc(3 * plane * sizeof *rgb);
    for (size_t i = 0; rgb && i < plane; i++)
        for (size_t c = 0; c < 3; c++) {
            const float *pixel = image->data + i * channels;
            rgb[c * plane + i] = channels == 4 && pixel[3] < COUNTS ? (float)NAN : pixel[c];
        }
    return rgb;
}

void adcgs_image_even_light(const adcgs_scene_view *view, float *rgb, size_t plane)
{
    float by[3];
    for (int c = 0; c < 3; c++)
        by[c] = (float)exp2(-(double)view->stops[c]);
    for (size_t i = 0; i < plane; i++) {
        int burnt = 0;
        for (size_t c = 0; c < 3; c++) {
            float *const value = &rgb[c * plane + i];
            const float most = fmaxf(*value, 1.0f);
            burnt |= *value >= ADCGS_BURNT && by[c] < 1.0f;
            *value = fminf(by[c] * *value, most);
        }
        for (size_t c = 0; burnt && c < 3; c++)
            rgb[c * plane + i] = (float)NAN;
    }
}

void adcgs_image_place_rows(float *rgb, size_t plane, size_t first, const adcgs_image_source *s, int divide)
{
    const int keeps = divide == 1 && s->image->channels == 3;
    for (int x = 0, at = 0; x < s->image->width; x += divide, at++) {
        float value[4];
        if (keeps)
            memcpy(value, s->image->data + 3 * (size_t)x, 3 * sizeof *value);
        else
            average_box(s, x, 0, divide, value);
        for (size_t c = 0; c < 3; c++)
            rgb[c * plane + first + (size_t)at] = value[c];
    }
}

/* ---- Moving regions ---- */

/** Replaces an image of any colours by one channel: 1 where it is not black, else 0. */
static adcgs_status to_zero_and_one(adcgs_image *image, const char *path, adcgs_error *error)
{
    adcgs_image out;
    ADCGS_TRY(adcgs_image_alloc(&out, image->width, image->height, 1, path, error));
    for (size_t i = 0; i < (size_t)out.width * (size_t)out.height; i++)
        out.data[i] = is_seen(image, i) ? 1.0f : 0.0f;
    adcgs_image_free(image);
    *image = out;
    return ADCGS_OK;
}

adcgs_status adcgs_scene_load_moving(const adcgs_scene_view *view, int divide, uint8_t **moving, adcgs_error *error)
{
    adcgs_image image;
    const adcgs_image_source straight = {&image, NULL, NULL};
    *moving = NULL;
    ADCGS_TRY(adcgs_view_mask_read(view, view->moving, &image, error));
    adcgs_status status = to_zero_and_one(&image, view->moving, error);
    if (status == ADCGS_OK && view->lens.width > 0)
        status = straighten(view, &image, 1, error);
    if (status == ADCGS_OK && divide > 1)
        status = reduce_image(&image, &straight, divide, view->moving, error);
    const size_t plane = (size_t)image.width * (size_t)image.height;
    if (status == ADCGS_OK && !(*moving = malloc(plane)))
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", view->moving);
    for (size_t i = 0; status == ADCGS_OK && i < plane; i++)
        (*moving)[i] = image.data[i * (size_t)image.channels] >= COUNTS;
    adcgs_image_free(&image);
    return status;
}
