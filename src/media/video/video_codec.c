/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Choosing codecs. */
#include "config.h"

#include "media/video/video_codec.h"

#include "media/video/video_planes.h"
#include "system/extension.h"

#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <stdlib.h>
#include <strings.h>

#define BITS_PER_PIXEL 1 /* for encoders without constant quality; chosen by hand, not measured */

typedef struct codec {
    const char *name, *family;             /* FFmpeg's encoder, and the codec's common name */
    const char *options;                   /* in FFmpeg's form, for little loss; "": by bit rate */
    int even;                              /* width and height must be even */
    enum AVPixelFormat format, with_alpha; /* NONE: no alpha */
} codec;

#define NO_ALPHA AV_PIX_FMT_NONE

/*
 * Rows of the table. x264 runs without mb-tree: its AVX-512 code reads uninitialised memory there, so the same frames would not
 * give the same bytes.
 */
enum { X264, OPENH264, X265, VP9, AOM, SVT, MPEG4, FFV1, PRORES, QTRLE };
static const codec codecs[] = {
    [X264] = {"libx264", "h264", "preset=medium:crf=12:x264-params=mbtree=0", 1, AV_PIX_FMT_YUV420P, NO_ALPHA},
    [OPENH264] = {"libopenh264", "h264", "", 1, AV_PIX_FMT_YUV420P, NO_ALPHA},
    [X265] = {"libx265", "hevc", "preset=medium:crf=14:x265-params=log-level=none", 1, AV_PIX_FMT_YUV420P, NO_ALPHA},
    [VP9] = {"libvpx-vp9", "vp9", "crf=12:b=0:deadline=good:cpu-used=2:row-mt=1", 0, AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUVA420P},
    [AOM] = {"libaom-av1", "av1", "crf=12:b=0:cpu-used=6:row-mt=1", 0, AV_PIX_FMT_YUV420P, NO_ALPHA},
    [SVT] = {"libsvtav1", "av1", "crf=15:preset=6", 1, AV_PIX_FMT_YUV420P, NO_ALPHA},
    [MPEG4] = {"mpeg4", "mpeg4", "flags=+qscale:global_quality=236", 0, AV_PIX_FMT_YUV420P, NO_ALPHA},
    [FFV1] = {"ffv1", "ffv1", "level=3:slicecrc=1", 0, AV_PIX_FMT_0RGB32, AV_PIX_FMT_RGB32},
    [PRORES] = {"prores_ks", "prores", "flags=+qscale:global_quality=472", 0, AV_PIX_FMT_YUV422P10, AV_PIX_FMT_YUVA444P10},
    [QTRLE] = {"qtrle", "qtrle", "g=30", 0, AV_PIX_FMT_RGB24, AV_PIX_FMT_ARGB},
};

#define ROW(i) (i) + 1 /* 0 ends a list */
static const struct {
    const char *extension, *name;
    signed char opaque[6], alpha[3];
} containers[] = {
    {"mp4", "mp4", {ROW(X264), ROW(OPENH264), ROW(VP9), ROW(AOM), ROW(MPEG4)}, {0}},
    {"m4v", "mp4", {ROW(X264), ROW(OPENH264), ROW(MPEG4)}, {0}},
    {"mov", "mov", {ROW(X264), ROW(OPENH264), ROW(MPEG4)}, {ROW(PRORES), ROW(QTRLE)}},
    {"mkv", "matroska", {ROW(X264), ROW(OPENH264), ROW(VP9), ROW(AOM), ROW(MPEG4)}, {ROW(FFV1), ROW(VP9)}},
    {"webm", "webm", {ROW(VP9), ROW(AOM)}, {ROW(VP9)}},
    {"avi", "avi", {ROW(X264), ROW(OPENH264), ROW(MPEG4)}, {0}},
};

/** The first codec of a list that FFmpeg has; NULL for none. */
static const codec *first_of(const signed char *list, const AVCodec **encoder)
{
    for (; *list; list++)
        if ((*encoder = avcodec_find_encoder_by_name(codecs[*list - 1].name)))
            return &codecs[*list - 1];
    return NULL;
}

/** A codec by its common name or FFmpeg's; one outside the table becomes *other. */
static const codec *find_codec(const char *name, codec *other, const AVCodec **encoder)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(codecs); i++)
        if ((!strcasecmp(name, codecs[i].family) || !strcmp(name, codecs[i].name)) &&
            (*encoder = avcodec_find_encoder_by_name(codecs[i].name)))
            return &codecs[i];
    const AVCodecDescriptor *const known = avcodec_descriptor_get_by_name(name);
    *encoder = avcodec_find_encoder_by_name(name);
    if (!*encoder && known)
        *encoder = avcodec_find_encoder(known->id);
    *other = (codec){name, name, "", 1, AV_PIX_FMT_NONE, AV_PIX_FMT_NONE};
    return *encoder && (*encoder)->type == AVMEDIA_TYPE_VIDEO ? other : NULL;
}

static adcgs_status find_container(size_t *at, const adcgs_video_target *target, adcgs_error *error)
{
    const char *extension = adcgs_extension(target->path);
    for (*at = 0; *at < ADCGS_COUNTOF(containers); ++*at)
        if (!strcasecmp(extension, containers[*at].extension))
            return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: videos are written as .mp4, .m4v, .mov, .mkv, .webm or .avi",
                      target->path);
}

/** The container's default codec, or the one that the user named, if the container supports it. */
static adcgs_status choose_codec(const codec **chosen, codec *other, size_t at, const adcgs_video_target *target,
                                 const AVCodec **encoder, adcgs_error *error)
{
    const adcgs_video_style *const style = &target->style;
    const char *const extension = containers[at].extension;
    if (style->codec) {
        *chosen = find_codec(style->codec, other, encoder);
        if (!*chosen)
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of FFmpeg has no encoder %s", target->path,
                              style->codec);
        if (avformat_query_codec(av_guess_format(containers[at].name, NULL, NULL), (*encoder)->id, FF_COMPLIANCE_NORMAL) != 1)
            return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: .%s files cannot hold %s", target->path, extension,
                              style->codec);
        return ADCGS_OK;
    }
    *chosen = first_of(style->has_alpha ? containers[at].alpha : containers[at].opaque, encoder);
    if (!*chosen && style->has_alpha)
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: no encoder with alpha for .%s; .mov, .mkv and .webm may have one",
                          target->path, extension);
    return *chosen ? ADCGS_OK
                   : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: this build of FFmpeg has no encoder for .%s", target->path,
                                extension);
}

/* ---- Formats of pixels ---- */

static int has_alpha(enum AVPixelFormat format)
{
    const AVPixFmtDescriptor *const d = av_pix_fmt_desc_get(format);
    return d && (d->flags & AV_PIX_FMT_FLAG_ALPHA);
}

static const enum AVPixelFormat *formats_of(const AVCodec *encoder)
{
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(61, 13, 100)
    const void *list = NULL;
    return avcodec_get_supported_config(NULL, encoder, AV_CODEC_CONFIG_PIX_FORMAT, 0, &list, NULL) < 0 ? NULL : list;
#else
    return encoder->pix_fmts;
#endif
}

/** True if frames can be converted to this format and encoded. */
static int suits(const AVCodec *encoder, enum AVPixelFormat format, int alpha)
{
    const enum AVPixelFormat *list = formats_of(encoder);
    if (!adcgs_video_planes_take(format) || (alpha && !has_alpha(format)))
        return 0;
    while (list && *list != AV_PIX_FMT_NONE && *list != format)
        list++;
    return !list || *list == format;
}

/** The pixel format that the user named, else the table's, else the first suitable one. */
static adcgs_status choose_format(adcgs_video_codec *out, const codec *chosen, const adcgs_video_target *target,
                                  adcgs_error *error)
{
    const int alpha = target->style.has_alpha;
    const AVDictionaryEntry *const named = av_dict_get(out->options, "pix_fmt", NULL, 0);
    out->format = named ? av_get_pix_fmt(named->value) : alpha ? chosen->with_alpha : chosen->format;
    if (named && !suits(out->encoder, out->format, alpha))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %s does not support pix_fmt=%s%s", target->path, out->encoder->name,
                          named->value, alpha ? " with alpha" : "");
    av_dict_set(&out->options, "pix_fmt", NULL, 0);
    const enum AVPixelFormat *list = formats_of(out->encoder);
    if (!suits(out->encoder, out->format, alpha))
        for (out->format = AV_PIX_FMT_NONE; list && *list != AV_PIX_FMT_NONE && out->format == AV_PIX_FMT_NONE; list++)
            if (suits(out->encoder, *list, alpha))
                out->format = *list;
    return out->format != AV_PIX_FMT_NONE ? ADCGS_OK
                                          : adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: %s has no %s", target->path,
                                                       out->encoder->name, alpha ? "alpha" : "supported pixel format");
}

/* ---- Options ---- */

/** Set the table's options, without those that would contradict the user's, then the user's. */
static adcgs_status set_options(adcgs_video_codec *out, const codec *chosen, const adcgs_video_target *target, adcgs_error *error)
{
    static const char *const qualities[] = {"crf", "b", "flags", "global_quality"};
    const adcgs_video_style *const style = &target->style;
    int code = av_dict_parse_string(&out->options, chosen->options, "=", ":", 0);
    for (size_t i = 0; i < ADCGS_COUNTOF(qualities) && style->bit_rate; i++)
        av_dict_set(&out->options, qualities[i], NULL, 0);
    out->bit_rate = (int64_t)style->bit_rate;
    if (!out->bit_rate && !*chosen->options && !style->has_crf)
        out->bit_rate = (int64_t)target->width * target->height * BITS_PER_PIXEL * target->rate[0] / target->rate[1];
    if (style->has_crf) {
        char text[32];
        snprintf(text, sizeof text, "%.9g", style->crf);
        av_dict_set(&out->options, "crf", text, 0);
    }
    if (code >= 0 && style->options)
        code = av_dict_parse_string(&out->options, style->options, "=", ":", 0);
    return code >= 0 ? ADCGS_OK
                     : adcgs_fail(error, ADCGS_ERR_USAGE, "%s: options %.100s: expected NAME=VALUE:NAME=VALUE", target->path,
                                  style->options);
}

adcgs_status adcgs_video_choose(adcgs_video_codec *out, const adcgs_video_target *target, adcgs_error *error)
{
    size_t at;
    codec other;
    const codec *chosen;
    *out = (adcgs_video_codec){0};
    ADCGS_TRY(find_container(&at, target, error));
    ADCGS_TRY(choose_codec(&chosen, &other, at, target, &out->encoder, error));
    out->container = containers[at].name;
    ADCGS_TRY(set_options(out, chosen, target, error));
    ADCGS_TRY(choose_format(out, chosen, target, error));
    out->even = chosen->even && av_pix_fmt_desc_get(out->format)->log2_chroma_w;
    return ADCGS_OK;
}

void adcgs_video_codec_clear(adcgs_video_codec *chosen)
{
    av_dict_free(&chosen->options);
}
