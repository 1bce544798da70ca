/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rendered frames as planes. */
#include "config.h"

#include "media/video/video_planes.h"

#include "media/video/ycbcr.h"

#include <libavutil/pixdesc.h>
#include <stdlib.h>

/* Rows of floats; definition: in the order of FFmpeg's components: R G B A, or Y Cb Cr A. */
enum { VALUES = 4, ALPHA = 3 };

static float clip(float v)
{
    const float low = v > 0.0f ? v : 0.0f;
    return low < 1.0f ? low : 1.0f;
}

/** Source of the rows. */
typedef struct source {
    const adcgs_frame *frame;
    const float *alpha; /**< NULL: all 1 */
    int is_rgb;
    int width; /**< of the rows: at least the frame's */
} source;

/** Convert one row to `width` values of each component. Premultiplied colours become straight. */
static void convert_row(float *row, const source *from, int y)
{
    const size_t first = (size_t)ADCGS_MIN(y, from->frame->height - 1) * (size_t)from->frame->width;
    const size_t step = (size_t)from->width;
    for (int x = 0; x < from->width; x++) {
        const size_t at = first + (size_t)ADCGS_MIN(x, from->frame->width - 1);
        const float *pixel = from->frame->rgb + 3 * at;
        const float alpha = from->alpha ? from->alpha[at] : 1.0f, scale = from->alpha && alpha > 0.0f ? 1.0f / alpha : 1.0f;
        const float rgb[3] = {clip(pixel[0] * scale), clip(pixel[1] * scale), clip(pixel[2] * scale)};
        float *const out = row + x;
        out[ALPHA * step] = clip(alpha);
        if (from->is_rgb)
            for (size_t c = 0; c < 3; c++)
                out[c * step] = rgb[c];
        else
            adcgs_ycbcr_from_rgb((adcgs_ycbcr)ADCGS_YCBCR_709, rgb, &out[0], &out[step], &out[2 * step]);
    }
}

/** A component's samples: position and form. A value v is stored as `low` + `span` v, rounded. */
typedef struct samples {
    uint8_t *at;
    int step, shift, wide;
    float low, span;
} samples;

static samples component(const AVFrame *to, const AVPixFmtDescriptor *format, int c, int y)
{
    const AVComponentDescriptor *const d = &format->comp[c];
    const int is_full = (format->flags & AV_PIX_FMT_FLAG_RGB) != 0 || c == ALPHA;
    const float unit = (float)(1 << (d->depth - 8)), most = (float)((1 << d->depth) - 1);
    return (samples){.at = to->data[d->plane] + (ptrdiff_t)y * to->linesize[d->plane] + d->offset,
                     .step = d->step,
                     .shift = d->shift,
                     .wide = d->depth + d->shift > 8,
                     .low = (is_full ? 0.0f
                             : c     ? 128.0f * unit
                                     : 16.0f * unit) +
                            0.5f,
                     .span = is_full ? most
                             : c     ? 224.0f * unit
                                     : 219.0f * unit};
}

static void put(const samples *to, int x, float value)
{
    uint8_t *const at = to->at + (ptrdiff_t)x * to->step;
    const unsigned v = (unsigned)(to->low + value) << to->shift;
    if (to->wide)
        memcpy(at, &(uint16_t){(uint16_t)v}, 2);
    else
        *at = (uint8_t)v;
}

static void put_row(const samples *to, const float *row, int width)
{
    for (int x = 0; x < width; x++)
        put(to, x, to->span * row[x]);
}

/** Every other column, filtered by weights 1 2 1, from one row or the mean of two. */
static void put_halved(const samples *to, const float *above, const float *below, int width)
{
    for (int x = 0; x < width; x += 2) {
        const int left = ADCGS_MAX(x - 1, 0), right = ADCGS_MIN(x + 1, width - 1);
        const float sum = above[left] + below[left] + 2.0f * (above[x] + below[x]) + above[right] + below[right];
        put(to, x / 2, 0.125f * to->span * sum);
    }
}

/** Write two rows of a frame, or the last row alone. */
static void put_rows(AVFrame *to, const AVPixFmtDescriptor *format, const float *above, const float *below, int y)
{
    const size_t step = (size_t)to->width;
    for (int c = 0; c < format->nb_components; c++) {
        const float *const rows[2] = {above + (size_t)c * step, below + (size_t)c * step};
        const int chroma = c == 1 || c == 2, slim = chroma && format->log2_chroma_w, tall = chroma && format->log2_chroma_h;
        for (int i = 0; i < (tall ? 1 : 2) && y + i < to->height; i++) {
            const samples out = component(to, format, c, tall ? y / 2 : y + i);
            if (slim)
                put_halved(&out, rows[i], tall ? rows[1] : rows[i], to->width);
            else
                put_row(&out, rows[i], to->width);
        }
    }
}

int adcgs_video_planes_take(enum AVPixelFormat format)
{
    static const uint64_t strange =
        AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT;
    const uint16_t probe = 1;
    const AVPixFmtDescriptor *const d = av_pix_fmt_desc_get(format);
    const int big = *(const uint8_t *)&probe == 0, is_big = d && (d->flags & AV_PIX_FMT_FLAG_BE);
    if (!d || d->nb_components < 3 || (d->flags & strange) || d->log2_chroma_w > 1 || d->log2_chroma_h > d->log2_chroma_w)
        return 0;
    for (int c = 0; c < d->nb_components; c++)
        if (d->comp[c].depth < 8 || d->comp[c].depth > 16 ||
            (d->comp[c].depth + d->comp[c].shift > 8 && is_big != big)) /* samples are stored in this machine's byte order */
            return 0;
    return 1;
}

adcgs_status adcgs_video_planes(AVFrame *to, const adcgs_frame *from, const float *alpha, adcgs_error *error)
{
    const AVPixFmtDescriptor *const format = av_pix_fmt_desc_get((enum AVPixelFormat)to->format);
    const source in = {from, alpha, (format->flags & AV_PIX_FMT_FLAG_RGB) != 0, to->width};
    float *above = malloc(2 * VALUES * (size_t)to->width * sizeof *above), *below = above + VALUES * (size_t)to->width;
    if (!above)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a row of %d pixels", to->width);
    for (int y = 0; y < to->height; y += 2) {
        convert_row(above, &in, y);
        convert_row(below, &in, ADCGS_MIN(y + 1, to->height - 1));
        put_rows(to, format, above, below, y);
    }
    free(above);
    return ADCGS_OK;
}
