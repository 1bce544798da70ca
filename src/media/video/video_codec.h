/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Coding of videos: containers, their codecs, and the codecs' options. */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_CODEC_H
#define ADCGS_MEDIA_VIDEO_VIDEO_CODEC_H

#include "media/video/video_ffmpeg.h"

#include <libavcodec/avcodec.h>

typedef struct adcgs_video_codec {
    const char *container; /**< as FFmpeg calls it */
    const AVCodec *encoder;
    AVDictionary *options;     /**< for avcodec_open2() */
    enum AVPixelFormat format; /**< a format that adcgs_video_planes_take() accepts */
    int even;                  /**< width and height must be even */
    int64_t bit_rate;          /**< 0: by constant quality */
} adcgs_video_codec;

/**
 * Choose a codec by the extension and the requested style: the container's first codec that this build of FFmpeg can encode. Call
 * adcgs_video_codec_clear() afterwards, after failure too. ADCGS_ERR_UNSUPPORTED if container, codec or FFmpeg lacks a requested
 * feature.
 */
adcgs_status adcgs_video_choose(adcgs_video_codec *out, const adcgs_video_target *target, adcgs_error *error);
void adcgs_video_codec_clear(adcgs_video_codec *chosen);

#endif
