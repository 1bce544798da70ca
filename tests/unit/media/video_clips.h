/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Clips of known samples, made by FFmpeg's encoders for the tests of reading, and their true pixels. */
#ifndef ADCGS_TESTS_VIDEO_CLIPS_H
#define ADCGS_TESTS_VIDEO_CLIPS_H

#include "outside_files.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <libavutil/spherical.h>
#include <math.h>

typedef struct recipe {
    const char *name, *encoder, *options; /* options in FFmpeg's syntax: a=b:c=d */
    enum AVPixelFormat format;
    int width, height, frames;
    enum AVColorSpace space; /* 0: RGB if samples are RGB, else unspecified */
    enum AVColorRange range;
    AVRational aspect;
    int turn; /* 90: the image has to be turned by a quarter, clockwise */
} recipe;

/** Properties of unusual clips. */
typedef struct clip_kind {
    enum AVColorTransferCharacteristic curve; /* 0: unspecified */
    int is_wide, is_round;                    /* primaries of BT.2020; an equirectangular panorama */
} clip_kind;

/** A sample: smooth, different in each frame, within the limited range. */
static inline int sample_at(int depth, int plane, int x, int y, int frame)
{
    const double wave = plane == 0 ? 110 + 70 * sin(0.11 * x + 0.3 * frame) * cos(0.07 * y)
                                   : 128 + 25 * sin(0.13 * y + plane - 0.2 * frame) * cos(0.09 * x);
    return (int)(wave * (1 << (depth - 8)));
}

static inline void fill(AVFrame *frame, int number)
{
    const AVPixFmtDescriptor *d = av_pix_fmt_desc_get((enum AVPixelFormat)frame->format);
    const int depth = d->comp[0].depth;
    for (int p = 0; p < d->nb_components; p++) {
        uint8_t *const data = frame->data[d->comp[p].plane];
        const int stride = frame->linesize[d->comp[p].plane], step = d->comp[p].step;
        const int w = p ? AV_CEIL_RSHIFT(frame->width, d->log2_chroma_w) : frame->width;
        const int h = p ? AV_CEIL_RSHIFT(frame->height, d->log2_chroma_h) : frame->height;
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                uint8_t *at = data + (ptrdiff_t)y * stride + x * step;
                const int v = sample_at(depth, p, x, y, number);
                if (depth > 8)
                    memcpy(at, &(uint16_t){(uint16_t)v}, 2);
                else
                    *at = (uint8_t)v;
            }
    }
}

static inline void drain(AVCodecContext *c, AVFormatContext *f, AVPacket *packet)
{
    while (!avcodec_receive_packet(c, packet)) {
        packet->duration = packet->duration ? packet->duration : 1;
        av_packet_rescale_ts(packet, c->time_base, f->streams[0]->time_base);
        assert_int_equal(av_interleaved_write_frame(f, packet), 0);
    }
}

static inline void set_turn(AVStream *stream)
{
    const int32_t quarter[9] = {0, 65536, 0, -65536, 0, 0, 0, 0, 1 << 30};
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 0)
    AVCodecParameters *par = stream->codecpar;
    AVPacketSideData *side =
        av_packet_side_data_new(&par->coded_side_data, &par->nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX, sizeof quarter, 0);
    assert_non_null(side);
    memcpy(side->data, quarter, sizeof quarter);
#else
    uint8_t *data = av_stream_new_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, sizeof quarter);
    assert_non_null(data);
    memcpy(data, quarter, sizeof quarter);
#endif
}

static inline void set_round(AVStream *stream)
{
    size_t bytes;
    AVSphericalMapping *const mapping = av_spherical_alloc(&bytes);
    assert_non_null(mapping);
    mapping->projection = AV_SPHERICAL_EQUIRECTANGULAR;
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 0)
    AVCodecParameters *par = stream->codecpar;
    assert_non_null(
        av_packet_side_data_add(&par->coded_side_data, &par->nb_coded_side_data, AV_PKT_DATA_SPHERICAL, mapping, bytes, 0));
#else
    assert_int_equal(av_stream_add_side_data(stream, AV_PKT_DATA_SPHERICAL, (uint8_t *)mapping, bytes), 0);
#endif
}

static inline AVCodecContext *open_encoder(const recipe *r, const clip_kind *kind, const AVCodec *codec, int global)
{
    AVCodecContext *c = avcodec_alloc_context3(codec);
    AVDictionary *options = NULL;
    c->width = r->width;
    c->height = r->height;
    c->pix_fmt = r->format;
    c->time_base = (AVRational){1, 25};
    c->framerate = (AVRational){25, 1};
    const int is_rgb = (av_pix_fmt_desc_get(r->format)->flags & AV_PIX_FMT_FLAG_RGB) != 0;
    c->colorspace = r->space || is_rgb ? r->space : AVCOL_SPC_UNSPECIFIED;
    c->color_range = r->range;
    c->color_trc = kind->curve ? kind->curve : AVCOL_TRC_UNSPECIFIED;
    c->color_primaries = kind->is_wide ? AVCOL_PRI_BT2020 : AVCOL_PRI_UNSPECIFIED;
    c->sample_aspect_ratio = r->aspect;
    c->gop_size = 12;
    c->flags |= global ? AV_CODEC_FLAG_GLOBAL_HEADER : 0;
    assert_true(av_dict_parse_string(&options, r->options, "=", ":", 0) >= 0);
    if (avcodec_open2(c, codec, &options) < 0)
        avcodec_free_context(&c);
    av_dict_free(&options);
    return c;
}

/** \return 0 if this build of FFmpeg cannot make the clip. */
static inline int make_clip_of(const recipe *r, const clip_kind *kind)
{
    const AVCodec *codec = avcodec_find_encoder_by_name(r->encoder);
    AVFormatContext *f = NULL;
    if (!codec)
        return 0;
    assert_true(avformat_alloc_output_context2(&f, NULL, NULL, in(r->name)) >= 0);
    AVCodecContext *c = open_encoder(r, kind, codec, f->oformat->flags & AVFMT_GLOBALHEADER);
    if (!c) {
        avformat_free_context(f);
        return 0;
    }
    AVStream *stream = avformat_new_stream(f, NULL);
    stream->time_base = c->time_base;
    stream->sample_aspect_ratio = r->aspect;
    avcodec_parameters_from_context(stream->codecpar, c);
    if (r->turn)
        set_turn(stream);
    if (kind->is_round)
        set_round(stream);
    f->strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL; /* writes the projection */
    assert_int_equal(avio_open(&f->pb, in(r->name), AVIO_FLAG_WRITE), 0);
    assert_true(avformat_write_header(f, NULL) >= 0);
    AVPacket *packet = av_packet_alloc();
    for (int i = 0; i < r->frames; i++) {
        AVFrame *frame = av_frame_alloc();
        frame->format = r->format;
        frame->width = r->width;
        frame->height = r->height;
        frame->pts = i;
        assert_int_equal(av_frame_get_buffer(frame, 0), 0);
        fill(frame, i);
        assert_int_equal(avcodec_send_frame(c, frame), 0);
        av_frame_free(&frame);
        drain(c, f, packet);
    }
    avcodec_send_frame(c, NULL);
    drain(c, f, packet);
    assert_int_equal(av_write_trailer(f), 0);
    av_packet_free(&packet);
    avio_closep(&f->pb);
    avformat_free_context(f);
    avcodec_free_context(&c);
    return 1;
}

static inline int make_clip(const recipe *r)
{
    return make_clip_of(r, &(clip_kind){.is_wide = 0});
}

/* ---- The true pixels, in double and one by one: the formulae of ITU-T H.273 ---- */

typedef double (*sample_fn)(const void *user, int plane, int x, int y);

typedef struct geometry {
    int width, height, sub_x, sub_y, depth, full;
    double red, blue;
} geometry;

static inline double between(const geometry *g, sample_fn sample, const void *user, int plane, int x, int y)
{
    const int w = (g->width + g->sub_x - 1) / g->sub_x, h = (g->height + g->sub_y - 1) / g->sub_y;
    const double u = fmin(fmax((double)x / g->sub_x, 0), w - 1), v = fmin(fmax((y - 0.5 * (g->sub_y - 1)) / g->sub_y, 0), h - 1);
    const int x0 = (int)u, y0 = (int)v, x1 = x0 + 1 < w ? x0 + 1 : x0, y1 = y0 + 1 < h ? y0 + 1 : y0;
    const double a = u - x0, b = v - y0;
    return (1 - b) * ((1 - a) * sample(user, plane, x0, y0) + a * sample(user, plane, x1, y0)) +
           b * ((1 - a) * sample(user, plane, x0, y1) + a * sample(user, plane, x1, y1));
}

static inline void true_pixel(const geometry *g, sample_fn sample, const void *user, int x, int y, double rgb[3])
{
    const double one = 1 << (g->depth - 8), all = (1 << g->depth) - 1;
    double luma = sample(user, 0, x, y), cb = between(g, sample, user, 1, x, y), cr = between(g, sample, user, 2, x, y);
    luma = g->full ? luma / all : (luma / one - 16) / 219;
    cb = g->full ? (cb - 128 * one) / all : (cb / one - 128) / 224;
    cr = g->full ? (cr - 128 * one) / all : (cr / one - 128) / 224;
    rgb[0] = luma + 2 * (1 - g->red) * cr;
    rgb[2] = luma + 2 * (1 - g->blue) * cb;
    rgb[1] = (luma - g->red * rgb[0] - g->blue * rgb[2]) / (1 - g->red - g->blue);
    for (int c = 0; c < 3; c++)
        rgb[c] = fmin(fmax(rgb[c], 0), 1);
}

typedef struct painted {
    int depth, frame;
} painted;

static inline double painted_sample(const void *user, int plane, int x, int y)
{
    const painted *p = user;
    return sample_at(p->depth, plane, x, y, p->frame);
}

#endif
