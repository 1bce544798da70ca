/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Table of the module with FFmpeg, and declarations that its parts share. The
 * front (video.c) uses only the table, and the table's types contain none of
 * FFmpeg's.
 */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_FFMPEG_H
#define ADCGS_MEDIA_VIDEO_VIDEO_FFMPEG_H

#include "media/video/video.h"
#include "system/module.h"

#include <stdio.h>

typedef struct adcgs_video_reader adcgs_video_reader;
typedef struct adcgs_video_encoder adcgs_video_encoder;

/** Output of an encoder. */
typedef struct adcgs_video_target {
    FILE *file;              /**< written and sought in, not closed */
    const char *path;        /**< its extension gives the container; also for messages; must outlive the encoder */
    int width, height;       /**< of the frames */
    int rate[2];             /**< frames per second: numerator and denominator, > 0 */
    adcgs_video_style style; /**< its strings are not used after begin() */
} adcgs_video_target;

typedef struct adcgs_ffmpeg {
    const char *version; /**< version of the programs that the module belongs to */
    adcgs_status (*open)(adcgs_video_reader **out, adcgs_video_info *info, const char *path, adcgs_error *error);
    void (*close)(adcgs_video_reader **reader);
    adcgs_status (*read)(adcgs_video_reader *reader, int64_t frame, adcgs_image *out, adcgs_error *error);
    /** Seconds since the first frame; NaN without timestamps in the file. */
    double (*time)(const adcgs_video_reader *reader, int64_t frame);
    /** stored: the size of the frames in the file, which some codecs need to be even. */
    adcgs_status (*begin)(adcgs_video_encoder **out, int stored[2], const adcgs_video_target *target, adcgs_error *error);
    adcgs_status (*add)(adcgs_video_encoder *encoder, const adcgs_frame *frame, const float *alpha, adcgs_error *error);
    /** Write the remaining packets and the container's end. */
    adcgs_status (*end)(adcgs_video_encoder *encoder, adcgs_error *error);
    void (*free)(adcgs_video_encoder **encoder);
} adcgs_ffmpeg;

/** The module's only exported symbol. */
ADCGS_MODULE_EXPORT extern const adcgs_ffmpeg adcgs_ffmpeg_table;

/* ---- Functions of the table, shared by the module's parts ---- */
adcgs_status adcgs_video_reader_open(adcgs_video_reader **out, adcgs_video_info *info, const char *path, adcgs_error *error);
void adcgs_video_reader_close(adcgs_video_reader **reader);
adcgs_status adcgs_video_reader_read(adcgs_video_reader *reader, int64_t frame, adcgs_image *out, adcgs_error *error);
double adcgs_video_reader_time(const adcgs_video_reader *reader, int64_t frame);
adcgs_status adcgs_video_encoder_begin(adcgs_video_encoder **out, int stored[2], const adcgs_video_target *target,
                                       adcgs_error *error);
adcgs_status adcgs_video_encoder_add(adcgs_video_encoder *encoder, const adcgs_frame *frame, const float *alpha,
                                     adcgs_error *error);
adcgs_status adcgs_video_encoder_end(adcgs_video_encoder *encoder, adcgs_error *error);
void adcgs_video_encoder_free(adcgs_video_encoder **encoder);

#endif
