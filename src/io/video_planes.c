/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rendered frames as planes of 8-bit 4:2:0. */
#include "config.h"

#include "io/video_planes.h"

#include "io/ycbcr.h"

#include <stdlib.h>

enum { Y, CB, CR };

static float clip(float v)
{
    const float low = v > 0.0f ? v : 0.0f;
    return low < 1.0f ? low : 1.0f;
}

/** One row: `width` values of Y, then of Cb, then of Cr. */
static void convert_row(float *row, int width, const adcgs_frame *from, int y)
{
    const float *in = from->rgb + (size_t)ADCGS_MIN(y, from->height - 1) * (size_t)from->width * 3;
    const size_t step = (size_t)width;
    for (int x = 0; x < width; x++) {
        const float *pixel = in + (size_t)ADCGS_MIN(x, from->width - 1) * 3;
        const float rgb[3] = {clip(pixel[0]), clip(pixel[1]), clip(pixel[2])};
        adcgs_ycbcr_from_rgb((adcgs_ycbcr)ADCGS_YCBCR_709, rgb, &row[x], &row[CB * step + (size_t)x],
                             &row[CR * step + (size_t)x]);
    }
}

static void put_luma(AVFrame *to, const float *row, int y)
{
    uint8_t *out = to->data[Y] + (ptrdiff_t)y * to->linesize[Y];
    for (int x = 0; x < to->width; x++)
        out[x] = (uint8_t)(16.5f + 219.0f * row[x]);
}

/** The mean of two rows, weighed 1 2 1 about every other column. */
static void put_chroma(AVFrame *to, const float *above, const float *below, int plane, int y)
{
    uint8_t *out = to->data[plane] + (ptrdiff_t)y * to->linesize[plane];
    above += (size_t)plane * (size_t)to->width;
    below += (size_t)plane * (size_t)to->width;
    for (int x = 0; x < to->width; x += 2) {
        const int left = ADCGS_MAX(x - 1, 0), right = ADCGS_MIN(x + 1, to->width - 1);
        const float sum = above[left] + below[left] + 2.0f * (above[x] + below[x]) + above[right] + below[right];
        out[x / 2] = (uint8_t)(128.5f + 28.0f * sum);
    }
}

adcgs_status adcgs_video_planes(AVFrame *to, const adcgs_frame *from, adcgs_error *error)
{
    float *above = malloc(6 * (size_t)to->width * sizeof *above), *below = above + 3 * (size_t)to->width;
    if (!above)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a row of %d pixels", to->width);
    for (int y = 0; y < to->height; y += 2) {
        convert_row(above, to->width, from, y);
        convert_row(below, to->width, from, ADCGS_MIN(y + 1, to->height - 1));
        put_luma(to, above, y);
        if (y + 1 < to->height)
            put_luma(to, below, y + 1);
        put_chroma(to, above, below, CB, y / 2);
        put_chroma(to, above, below, CR, y / 2);
    }
    free(above);
    return ADCGS_OK;
}
