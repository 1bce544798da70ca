/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Masks: images that mark the pixels of another image that count. COLMAP and nerfstudio evaluate colours, nerfstudio refuses
 * masks with several channels, and Brush evaluates alpha if present. So both are evaluated, provided that only one of them
 * distinguishes pixels or both agree.
 */
#include "config.h"

#include "data/mask.h"

#define SAME_SHARE 0.01 /* share of the pixels on which both may differ, for soft edges */

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

adcgs_status adcgs_mask_settle(adcgs_image *mask, const char *path, adcgs_error *error)
{
    if (mask->channels % 2)
        return ADCGS_OK;
    const counts n = count(mask);
    const int by_alpha = n.clear > 0 && n.clear < n.all, by_colour = !by_alpha || (n.black > 0 && n.black < n.all);
    adcgs_image out;
    if (by_colour && by_alpha && (double)(n.either - n.both) > SAME_SHARE * (double)n.all)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: its black hides %.0f %% of the pixels and its alpha %.0f %%, but they "
                          "disagree: save the mask without one of the two", path, 100.0 * (double)n.black / (double)n.all,
                          100.0 * (double)n.clear / (double)n.all);
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
