/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Video files through FFmpeg's libraries, in a module of their own. Colours
 * become RGB by the stream's own matrix and range (BT.709 where it names none
 * and is large, BT.601 where small, limited range where it names none).
 */
#ifndef ADCGS_IO_VIDEO_H
#define ADCGS_IO_VIDEO_H

#include "io/image.h"
#include "io/fps.h"

#include <adcgs/types.h>

typedef struct adcgs_video adcgs_video;

typedef struct adcgs_video_info {
    int width, height;    /**< as shown: rotation applied, square pixels */
    int64_t frames;       /**< counted, not believed */
    adcgs_fps rate;      /**< the mean one, known */
} adcgs_video_info;

/** Does the name end like a video file's (mp4, mov, mkv, webm, avi, m4v, ...)? */
int adcgs_is_video(const char *path);

/**
 * ADCGS_ERR_UNSUPPORTED without FFmpeg or for a codec it lacks, ADCGS_ERR_IO if the file is not there, ADCGS_ERR_DATA if it is
 * no video, or one without a frame.
 */
adcgs_status adcgs_video_open(adcgs_video **out, const char *path, adcgs_error *error);
void adcgs_video_close(adcgs_video **video);
const adcgs_video_info *adcgs_video_get_info(const adcgs_video *video);
/**
 * The frame of an index in the order in which they are shown, from 0: three channels. Cheap in ascending order; one thread at a
 * time. A frame that is missing or damaged is ADCGS_ERR_DATA, naming file and frame.
 */
adcgs_status adcgs_video_read(adcgs_video *video, int64_t frame, adcgs_image *out, adcgs_error *error);

/** Seconds from the first frame to this one, as the file says; by the mean rate where it does not say. */
double adcgs_video_time(const adcgs_video *video, int64_t frame);

typedef struct adcgs_video_writer adcgs_video_writer;

/** How a video is coded. All zero: by its container, H.264 or what FFmpeg has for it, with little loss. */
typedef struct adcgs_video_style {
    const char *codec;   /**< what FFmpeg calls an encoder or a codec, or what people do; NULL: by the container */
    const char *options; /**< for the encoder, as FFmpeg's: "name=value:name=value"; also pix_fmt. NULL: none */
    double crf;          /**< a constant rate factor, where has_crf says so */
    int has_crf;
    uint64_t bit_rate;   /**< bits in a second; 0: by quality */
    int has_alpha;       /**< frames come with alpha, which the codec must have */
} adcgs_video_style;

/** Container by the name's end; BT.709 of limited range, or RGB, tagged as such. */
adcgs_status adcgs_video_write_open(adcgs_video_writer **out, const char *path, int width, int height, double frame_rate,
                                    adcgs_error *error);
/** As adcgs_video_write_open(), in a style, whose strings are not needed afterwards. */
adcgs_status adcgs_video_write_open_as(adcgs_video_writer **out, const char *path, int width, int height, double frame_rate,
                                       const adcgs_video_style *style, adcgs_error *error);
/** The size of the pictures in the file: the frames', or where the codec takes even sizes only, one row or column more. */
void adcgs_video_write_size(const adcgs_video_writer *writer, int *width, int *height);
adcgs_status adcgs_video_write_frame(adcgs_video_writer *writer, const adcgs_frame *frame, adcgs_error *error);
/** With alpha, [height][width], by which the colours are premultiplied; the file has them straight. NULL: opaque. */
adcgs_status adcgs_video_write_frame_with(adcgs_video_writer *writer, const adcgs_frame *frame, const float *alpha,
                                          adcgs_error *error);
/** Complete the file. On failure, and after adcgs_video_write_abort(), nothing is left behind. */
adcgs_status adcgs_video_write_close(adcgs_video_writer **writer, adcgs_error *error);
void adcgs_video_write_abort(adcgs_video_writer **writer);

#endif
