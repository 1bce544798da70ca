/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How films are coded: containers, the codecs that each takes, what they are told. */
#ifndef ADCGS_IO_VIDEO_CODEC_H
#define ADCGS_IO_VIDEO_CODEC_H

#include "io/video_ffmpeg.h"

#include <libavcodec/avcodec.h>

typedef struct adcgs_video_codec {
    const char *container;     /**< as FFmpeg calls it */
    const AVCodec *encoder;
    AVDictionary *options;     /**< for avcodec_open2() */
    enum AVPixelFormat format; /**< one that adcgs_video_planes_take() */
    int even;                  /**< sizes must be */
    int64_t bit_rate;          /**< 0: by constant quality */
} adcgs_video_codec;

/**
 * By the name's end and what is asked for: the first of the container's codecs that this build of FFmpeg can encode.
 * adcgs_video_codec_clear() afterwards, whatever it returned. ADCGS_ERR_UNSUPPORTED for what container, codec or FFmpeg has not.
 */
adcgs_status adcgs_video_choose(adcgs_video_codec *out, const adcgs_video_target *target, adcgs_error *error);
void adcgs_video_codec_clear(adcgs_video_codec *chosen);

#endif
