/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Masks: images that mark the pixels of another image that count. COLMAP and nerfstudio evaluate colours, nerfstudio refuses
 * masks with several channels, and Brush evaluates alpha if present. So both are evaluated, provided that only one of them
 * distinguishes pixels or both agree.
 */
#include "config.h"

#include "scene/mask.h"

#include "media/kind.h"

#include <math.h>

/* Share of the pixels on which both may differ, for soft edges; chosen by hand, not measured. */
#define SAME_SHARE 0.01
/* Largest value of black after JPEG's errors, for pixels from 0 to 1; chosen by hand, not measured. */
#define NEARLY_BLACK 0.1f

static int is_black(const float *pixel, int channels)
{
    int black = 1;
    for (int c = 0; c < channels - 1; c++)
        black &= !(pixel[c] > 0.0f);
    return black;
}

static int is_clear(const float *pixel, int channels)
{
    return !(pixel[channels - 1] > 0.0f);
}

/** Numbers of hidden pixels. */
typedef struct counts {
    size_t all, black, clear, either, both;
} counts;

static counts count(const adcgs_image *mask)
{
    counts n = {.all = (size_t)mask->width * (size_t)mask->height};
    for (size_t i = 0; i < n.all; i++) {
        const float *pixel = mask->data + i * (size_t)mask->channels;
        const int black = is_black(pixel, mask->channels), clear = is_clear(pixel, mask->channels);
        n.black += (size_t)black;
        n.clear += (size_t)clear;
        n.either += (size_t)(black | clear);
        n.both += (size_t)(black & clear);
    }
    return n;
}

/** Sets nearly black pixels of a JPEG file to 0. JPEG keeps black only approximately, so a test for 0 would hide no pixel. */
static void blacken(adcgs_image *mask, const char *path)
{
    const char *const reader = adcgs_kind_at(path)->reader;
    const size_t n = (size_t)mask->width * (size_t)mask->height, channels = (size_t)mask->channels;
    if (!reader || strcmp(reader, "jpeg") != 0)
        return;
    for (size_t i = 0; i < n; i++) {
        float most = 0.0f;
        for (size_t c = 0; c < channels; c++)
            most = fmaxf(most, mask->data[i * channels + c]);
        for (size_t c = 0; c < channels && most < NEARLY_BLACK; c++)
            mask->data[i * channels + c] = 0.0f;
    }
}

adcgs_status adcgs_mask_settle(adcgs_image *mask, const char *path, adcgs_error *error)
{
    if (mask->channels % 2) {
        blacken(mask, path);
        return ADCGS_OK;
    }
    const counts n = count(mask);
    const int by_alpha = n.clear > 0 && n.clear < n.all, by_colour = !by_alpha || (n.black > 0 && n.black < n.all);
    adcgs_image out;
    if (by_colour && by_alpha && (double)(n.either - n.both) > SAME_SHARE * (double)n.all)
        return adcgs_fail(error, ADCGS_ERR_DATA,
                          "%s: its black hides %.0f %% of the pixels and its alpha %.0f %%, but they "
                          "disagree: save the mask without one of the two",
                          path, 100.0 * (double)n.black / (double)n.all, 100.0 * (double)n.clear / (double)n.all);
    ADCGS_TRY(adcgs_image_alloc(&out, mask->width, mask->height, 1, path, error));
    for (size_t i = 0; i < n.all; i++) {
        const float *pixel = mask->data + i * (size_t)mask->channels;
        const int hidden = (by_colour && is_black(pixel, mask->channels)) || (by_alpha && is_clear(pixel, mask->channels));
        out.data[i] = hidden ? 0.0f : 1.0f;
    }
    adcgs_image_free(mask);
    *mask = out;
    return ADCGS_OK;
}

/* ---- Sizes ---- */

int adcgs_mask_fits(int width, int height, int image_width, int image_height)
{
    const double x = (double)image_width / width, y = (double)image_height / height, slack = fmax(1.0, fmax(x, y));
    if ((width == image_width) != (height == image_height))
        return 0;
    return fabs(image_width - y * width) <= slack || fabs(image_height - x * height) <= slack;
}

adcgs_status adcgs_mask_resize(adcgs_image *mask, int width, int height, const char *path, adcgs_error *error)
{
    const size_t bytes = (size_t)mask->channels * sizeof *mask->data;
    adcgs_image out;
    if (mask->width == width && mask->height == height)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_image_alloc(&out, width, height, mask->channels, path, error));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const size_t u = (size_t)((2 * (int64_t)x + 1) * mask->width / (2 * width));
            const size_t v = (size_t)((2 * (int64_t)y + 1) * mask->height / (2 * height));
            memcpy(out.data + ((size_t)y * (size_t)width + (size_t)x) * (size_t)mask->channels,
                   mask->data + (v * (size_t)mask->width + u) * (size_t)mask->channels, bytes);
        }
    adcgs_image_free(mask);
    *mask = out;
    return ADCGS_OK;
}

int adcgs_mask_shows(const adcgs_image *mask)
{
    const size_t n = (size_t)mask->width * (size_t)mask->height * (size_t)mask->channels;
    for (size_t i = 0; i < n; i++)
        if (mask->data[i] > 0.0f)
            return 1;
    return 0;
}
