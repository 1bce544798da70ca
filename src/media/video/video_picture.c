/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decoded frames as images: samples and colours. Aspect and orientation are in
 * video_shape.c.
 */
#include "config.h"

#include "media/video/video_picture.h"

#include "media/video/video_shape.h"
#include "media/video/ycbcr.h"

#include <libavutil/pixdesc.h>
#include <stdlib.h>

/* Pixels: smallest size at which a stream without a declared matrix is taken as BT.709. Chosen by hand, not measured;
   BT.601 has 576 lines at most. */
#define LARGE_WIDTH 1280
#define LARGE_HEIGHT 577

typedef struct source {
    const AVFrame *frame;
    const AVPixFmtDescriptor *desc;
    const uint8_t *data[4];
    int width, height;
    float zero[3], scale[3]; /* value = (sample - zero) * scale: 0..1, chroma -0.5..0.5 */
    adcgs_ycbcr weights;     /* not used for RGB */
    adcgs_hdr hdr;
    int is_wide;           /* primaries of BT.2020 */
    float from[2];         /* offset of the first chroma sample from the first luma sample, right and down [pixels] */
    uint16_t *samples;     /* one row as stored */
    int (*column)[2];      /* for each column of pixels, the chroma columns before and after it */
    float *right;          /* weight of the chroma column after it */
    float *blend, *row[3]; /* one row of chroma as stored; one row of pixels for each component */
} source;

static int is_rgb(const source *s)
{
    return (s->desc->flags & AV_PIX_FMT_FLAG_RGB) != 0;
}

static int is_grey(const source *s)
{
    return s->desc->nb_components < 3;
}

static int is_full_range(const source *s)
{
    const enum AVPixelFormat format = (enum AVPixelFormat)s->frame->format;
    if (s->frame->color_range != AVCOL_RANGE_UNSPECIFIED)
        return s->frame->color_range == AVCOL_RANGE_JPEG;
    return is_rgb(s) || is_grey(s) || format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P ||
           format == AV_PIX_FMT_YUVJ444P || format == AV_PIX_FMT_YUVJ440P || format == AV_PIX_FMT_YUVJ411P;
}

static adcgs_status choose_weights(source *s, const char *name, adcgs_error *error)
{
    static const struct {
        enum AVColorSpace space;
        adcgs_ycbcr weights;
    } known[] = {
        {AVCOL_SPC_BT709, ADCGS_YCBCR_709}, {AVCOL_SPC_BT470BG, ADCGS_YCBCR_601},    {AVCOL_SPC_SMPTE170M, ADCGS_YCBCR_601},
        {AVCOL_SPC_FCC, {0.30f, 0.11f}},    {AVCOL_SPC_SMPTE240M, {0.212f, 0.087f}}, {AVCOL_SPC_BT2020_NCL, {0.2627f, 0.0593f}},
    };
    const enum AVColorSpace space = s->frame->colorspace;
    if (is_rgb(s) || is_grey(s))
        return ADCGS_OK;
    if (space == AVCOL_SPC_UNSPECIFIED || space == AVCOL_SPC_RESERVED) {
        const int large = s->width >= LARGE_WIDTH || s->height >= LARGE_HEIGHT;
        s->weights = large ? known[0].weights : known[1].weights;
        return ADCGS_OK;
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(known); i++)
        if (space == known[i].space) {
            s->weights = known[i].weights;
            return ADCGS_OK;
        }
    const char *named = av_color_space_name(space);
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: the colour matrix %s is not supported", name,
                      named ? named : "without a name");
}

/** Check for integer samples of at most 16 bits, Y Cb Cr or RGB or grey. */
static adcgs_status check_format(const source *s, const char *name, adcgs_error *error)
{
    const uint64_t strange =
        AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM | AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT;
    const enum AVPixelFormat format = (enum AVPixelFormat)s->frame->format;
    int good = s->desc && !(s->desc->flags & strange) && format != AV_PIX_FMT_XYZ12LE && format != AV_PIX_FMT_XYZ12BE;
    for (int c = 0; good && c < s->desc->nb_components; c++)
        good = s->desc->comp[c].depth <= 16;
    return good ? ADCGS_OK
                : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: pixels of the kind %s are not supported", name,
                             s->desc ? s->desc->name : "without a name");
}

static void set_levels(source *s)
{
    const int full = is_full_range(s), n = is_grey(s) ? 1 : 3;
    for (int c = 0; c < n; c++) {
        const int depth = s->desc->comp[c].depth, chroma = c > 0 && !is_rgb(s);
        const float unit = depth >= 8 ? (float)(1 << (depth - 8)) : 1.0f / (float)(1 << (8 - depth));
        s->zero[c] = chroma ? 128.0f * unit : full ? 0.0f : 16.0f * unit;
        s->scale[c] = 1.0f / (full ? (float)((1 << depth) - 1) : (chroma ? 224.0f : 219.0f) * unit);
    }
}

static void set_chroma_place(source *s)
{
    const enum AVChromaLocation place = s->frame->chroma_location;
    const int between = place == AVCHROMA_LOC_CENTER || place == AVCHROMA_LOC_TOP || place == AVCHROMA_LOC_BOTTOM;
    const int top = place == AVCHROMA_LOC_TOPLEFT || place == AVCHROMA_LOC_TOP;
    const int bottom = place == AVCHROMA_LOC_BOTTOMLEFT || place == AVCHROMA_LOC_BOTTOM;
    s->from[0] = between ? 0.5f * (float)((1 << s->desc->log2_chroma_w) - 1) : 0.0f;
    s->from[1] = (top ? 0.0f : bottom ? 1.0f : 0.5f) * (float)((1 << s->desc->log2_chroma_h) - 1);
}

static void read_row(const source *s, int component, int y, int width)
{
    const AVComponentDescriptor *at = &s->desc->comp[component];
    if (at->depth == 8 && at->step == 1 && !at->shift) { /* the common case, much faster than the general function */
        const uint8_t *from = s->data[at->plane] + (ptrdiff_t)y * s->frame->linesize[at->plane] + at->offset;
        for (int x = 0; x < width; x++)
            s->samples[x] = from[x];
        return;
    }
    const uint8_t *data[4];
    memcpy(data, s->data, sizeof data);
    av_read_image_line2(s->samples, data, s->frame->linesize, s->desc, 0, y, component, width, 0, sizeof *s->samples);
}

static void plain_row(const source *s, int component, int y)
{
    float *row = s->row[component];
    const float zero = s->zero[component], scale = s->scale[component];
    read_row(s, component, y, s->width);
    for (int x = 0; x < s->width; x++)
        row[x] = ((float)s->samples[x] - zero) * scale;
}

/** Position among n samples that are 2^shift apart: the sample before it, and the weight of the one after. */
static float place_of(int at, float from, int shift, int n, int *before, int *after)
{
    const float place = ((float)at - from) / (float)(1 << shift);
    const float inside = ADCGS_MIN(ADCGS_MAX(place, 0.0f), (float)(n - 1));
    *before = (int)inside;
    *after = ADCGS_MIN(*before + 1, n - 1);
    return inside - (float)*before;
}

static void chroma_row(const source *s, int component, int y)
{
    const int shift[2] = {s->desc->log2_chroma_w, s->desc->log2_chroma_h};
    const int width = AV_CEIL_RSHIFT(s->width, shift[0]), height = AV_CEIL_RSHIFT(s->height, shift[1]);
    int before, after;
    const float below = place_of(y, s->from[1], shift[1], height, &before, &after);
    read_row(s, component, before, width);
    for (int x = 0; x < width; x++)
        s->blend[x] = (float)s->samples[x];
    if (below > 0.0f) {
        read_row(s, component, after, width);
        for (int x = 0; x < width; x++)
            s->blend[x] += ((float)s->samples[x] - s->blend[x]) * below;
    }
    float *row = s->row[component];
    const float zero = s->zero[component], scale = s->scale[component];
    for (int x = 0; x < s->width; x++) {
        const float left = s->blend[s->column[x][0]];
        row[x] = (left + (s->blend[s->column[x][1]] - left) * s->right[x] - zero) * scale;
    }
}

static float clip(float v)
{
    return ADCGS_MIN(ADCGS_MAX(v, 0.0f), 1.0f);
}

static void colour_row(const source *s, float *out)
{
    const int grey = is_grey(s), plain = grey || is_rgb(s);
    const float *a = s->row[0], *b = s->row[grey ? 0 : 1], *c = s->row[grey ? 0 : 2];
    for (int x = 0; x < s->width; x++, out += 3) {
        float rgb[3] = {a[x], b[x], c[x]};
        if (!plain)
            adcgs_ycbcr_to_rgb(s->weights, a[x], b[x], c[x], rgb);
        if (s->hdr)
            adcgs_hdr_convert(s->hdr, s->is_wide, rgb);
        for (int k = 0; k < 3; k++)
            out[k] = clip(rgb[k]);
    }
}

static void convert(source *s, adcgs_image *out)
{
    const int width = AV_CEIL_RSHIFT(s->width, s->desc->log2_chroma_w);
    for (int x = 0; x < s->width; x++)
        s->right[x] = place_of(x, s->from[0], s->desc->log2_chroma_w, width, &s->column[x][0], &s->column[x][1]);
    const int components = is_grey(s) ? 1 : 3;
    for (int y = 0; y < s->height; y++) {
        for (int c = 0; c < components; c++)
            if (c && !is_rgb(s))
                chroma_row(s, c, y);
            else
                plain_row(s, c, y);
        colour_row(s, out->data + (size_t)y * (size_t)s->width * 3);
    }
}

adcgs_hdr adcgs_video_hdr(const AVFrame *frame)
{
    return frame->color_trc == AVCOL_TRC_ARIB_STD_B67 ? ADCGS_HDR_HLG
           : frame->color_trc == AVCOL_TRC_SMPTE2084  ? ADCGS_HDR_PQ
                                                      : ADCGS_HDR_NONE;
}

adcgs_status adcgs_video_picture(adcgs_image *out, const AVFrame *frame, const adcgs_video_view *view, const char *name,
                                 adcgs_error *error)
{
    source s = {.frame = frame, .width = frame->width, .height = frame->height};
    *out = (adcgs_image){0};
    s.desc = av_pix_fmt_desc_get((enum AVPixelFormat)frame->format);
    memcpy(s.data, frame->data, sizeof s.data);
    ADCGS_TRY(check_format(&s, name, error));
    ADCGS_TRY(choose_weights(&s, name, error));
    ADCGS_TRY(adcgs_image_alloc(out, s.width, s.height, 3, name, error));
    s.hdr = adcgs_video_hdr(frame);
    s.is_wide = frame->color_primaries == AVCOL_PRI_BT2020;
    set_levels(&s);
    set_chroma_place(&s);
    const size_t width = (size_t)s.width;
    s.samples = malloc(width * sizeof *s.samples);
    s.column = malloc(width * sizeof *s.column);
    s.blend = malloc(5 * width * sizeof *s.blend);
    adcgs_status status = ADCGS_OK;
    if (s.samples && s.column && s.blend) {
        for (int c = 0; c < 3; c++)
            s.row[c] = s.blend + (size_t)(c + 1) * width;
        s.right = s.blend + 4 * width;
        convert(&s, out);
    } else
        status = adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", name);
    free(s.samples);
    free(s.column);
    free(s.blend);
    if (status == ADCGS_OK)
        status = adcgs_video_square(out, view->aspect, name, error);
    if (status == ADCGS_OK)
        status = adcgs_video_turn(out, view->matrix, name, error);
    if (status != ADCGS_OK)
        adcgs_image_free(out);
    return status;
}
