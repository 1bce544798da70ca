/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Aspect and orientation of a video's images. */
#include "config.h"

#include "media/video/video_shape.h"

#include <math.h>

/** Centre of pixel i of n among m pixels along the same side: the pixel before it, and the weight of the one after. */
static float place_of(int i, int n, int m, int *before, int *after)
{
    const double place = (i + 0.5) * m / n - 0.5, inside = fmin(fmax(place, 0.0), m - 1.0);
    *before = (int)inside;
    *after = ADCGS_MIN(*before + 1, m - 1);
    return (float)(inside - *before);
}

static void stretch(const adcgs_image *from, adcgs_image *to)
{
    for (int y = 0; y < to->height; y++) {
        int row[2];
        const float below = place_of(y, to->height, from->height, &row[0], &row[1]);
        const float *above_row = from->data + (size_t)row[0] * (size_t)from->width * 3;
        const float *below_row = from->data + (size_t)row[1] * (size_t)from->width * 3;
        float *out = to->data + (size_t)y * (size_t)to->width * 3;
        for (int x = 0; x < to->width; x++) {
            int at[2];
            const float right = place_of(x, to->width, from->width, &at[0], &at[1]);
            for (int c = 0; c < 3; c++) {
                const float above = above_row[3 * at[0] + c] * (1.0f - right) + above_row[3 * at[1] + c] * right;
                const float under = below_row[3 * at[0] + c] * (1.0f - right) + below_row[3 * at[1] + c] * right;
                *out++ = above * (1.0f - below) + under * below;
            }
        }
    }
}

adcgs_status adcgs_video_square(adcgs_image *image, AVRational aspect, const char *name, adcgs_error *error)
{
    if (aspect.num <= 0 || aspect.den <= 0 || aspect.num == aspect.den)
        return ADCGS_OK;
    const double ratio = av_q2d(aspect);
    const double width = ratio > 1 ? floor(image->width * ratio + 0.5) : image->width;
    const double height = ratio > 1 ? image->height : floor(image->height / ratio + 0.5);
    if (width > ADCGS_IMAGE_MAX || height > ADCGS_IMAGE_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: %dx%d pixels, each %d:%d, expected at most %dx%d square ones", name,
                          image->width, image->height, aspect.num, aspect.den, ADCGS_IMAGE_MAX, ADCGS_IMAGE_MAX);
    adcgs_image square;
    ADCGS_TRY(adcgs_image_alloc(&square, (int)width, (int)height, 3, name, error));
    stretch(image, &square);
    adcgs_image_free(image);
    *image = square;
    return ADCGS_OK;
}

/** True if one number is negligible compared with the other. */
static int vanishes(int32_t small, int32_t large)
{
    return 100 * fabs((double)small) < fabs((double)large);
}

/** Copy pixels, optionally transposed (across), then mirrored in x or y. */
static void move_pixels(const adcgs_image *from, adcgs_image *to, int across, int mirror_x, int mirror_y)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            const int u = mirror_x ? to->width - 1 - x : x, v = mirror_y ? to->height - 1 - y : y;
            const size_t at = across ? (size_t)u * (size_t)from->width + (size_t)v : (size_t)v * (size_t)from->width + (size_t)u;
            memcpy(to->data + ((size_t)y * (size_t)to->width + (size_t)x) * 3, from->data + at * 3, 3 * sizeof(float));
        }
}

/* The matrix (a b u, c d v, x y w) maps a point (p, q) of the image to (a p + c q, b p + d q), apart from a translation. */
adcgs_status adcgs_video_turn(adcgs_image *image, const int32_t *matrix, const char *name, adcgs_error *error)
{
    if (!matrix)
        return ADCGS_OK;
    const int32_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
    const int upright = vanishes(b, a) && vanishes(c, d), across = vanishes(a, b) && vanishes(d, c);
    if (!upright && !across)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: turned by other than a right angle", name);
    const int mirror_x = (across ? c : a) < 0, mirror_y = (across ? b : d) < 0;
    if (!across && !mirror_x && !mirror_y)
        return ADCGS_OK;
    adcgs_image turned;
    ADCGS_TRY(
        adcgs_image_alloc(&turned, across ? image->height : image->width, across ? image->width : image->height, 3, name, error));
    move_pixels(image, &turned, across, mirror_x, mirror_y);
    adcgs_image_free(image);
    *image = turned;
    return ADCGS_OK;
}
