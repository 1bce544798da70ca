/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Table of the module with FFmpeg. */
#include "config.h"

#include "media/video/video_ffmpeg.h"

const adcgs_ffmpeg adcgs_ffmpeg_table = {
    .version = PACKAGE_VERSION,
    .open = adcgs_video_reader_open,
    .close = adcgs_video_reader_close,
    .read = adcgs_video_reader_read,
    .time = adcgs_video_reader_time,
    .begin = adcgs_video_encoder_begin,
    .add = adcgs_video_encoder_add,
    .end = adcgs_video_encoder_end,
    .free = adcgs_video_encoder_free,
};
