/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Output of rendered frames: numbered images, a video file, Y4M, raw pixels, or
 * none. Files appear complete or not at all; "-" is standard output.
 */
#ifndef ADCGS_MEDIA_SINK_H
#define ADCGS_MEDIA_SINK_H

#include "media/video/video.h"

#include <adcgs/types.h>

typedef struct adcgs_sink adcgs_sink;

typedef enum adcgs_depth {
    ADCGS_DEPTH_DEFAULT, /**< EXR: half; all others: 8 bit */
    ADCGS_DEPTH_HALF,    /**< EXR only */
    ADCGS_DEPTH_FLOAT,   /**< EXR and raw only */
    ADCGS_DEPTH_16       /**< PNG, TIFF and PPM only */
} adcgs_depth;

typedef struct adcgs_sink_config {
    const char *target; /**< "-", a file, or for images a pattern with %d or %04d */
    const char *format; /**< NULL: by the target's extension, Y4M for "-". Else y4m, raw, null, an extension of images (for
                              any target name), or an extension of videos, which the target must have */
    adcgs_depth depth;
    int linear;        /**< EXR only: colours in linear light */
    double frame_rate; /**< for Y4M and videos */
    int width, height;
    int frames;                     /**< number of frames; several images need a pattern */
    int has_alpha;                  /**< frames have alpha, which EXR, PNG, TIFF and some videos support */
    const adcgs_video_style *video; /**< coding of a video, except alpha; NULL: defaults of the container */
    int has_z;                      /**< frames have depth, which EXR supports */
} adcgs_sink_config;

/** Data that may accompany a frame's colours. */
typedef struct adcgs_sink_extras {
    const float *alpha;         /**< [height][width]; the colours are premultiplied by it, without background. NULL: none */
    const float *depth;         /**< [height][width], for EXR's channel Z. NULL: none */
    const adcgs_camera *camera; /**< for EXR's attributes. NULL: none */
    double time;                /**< seconds, with a camera */
} adcgs_sink_extras;

/** The strings of config must outlive the sink. */
adcgs_status adcgs_sink_open(adcgs_sink **out, const adcgs_sink_config *config, adcgs_error *error);
/** The size of the stored images: that of the frames, except for videos whose codec needs even sizes. */
void adcgs_sink_size(const adcgs_sink *sink, int *width, int *height);
/** Write a frame. index: the image's number in a pattern. */
adcgs_status adcgs_sink_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error);
/**
 * As adcgs_sink_write(), with the extra data that the configuration announced. Outputs without attributes ignore camera and time.
 */
adcgs_status adcgs_sink_write_with(adcgs_sink *sink, const adcgs_frame *frame, const adcgs_sink_extras *extras, int index,
                                   adcgs_error *error);
/** Complete the output. *sink may be NULL. */
adcgs_status adcgs_sink_close(adcgs_sink **sink, adcgs_error *error);
/** Abort: an incomplete file disappears. *sink may be NULL. */
void adcgs_sink_abort(adcgs_sink **sink);

/** Replace the single %d, %Nd or %0Nd of pattern by index; "%%" is a percent sign. -1 if the pattern is malformed. */
int adcgs_pattern_format(const char *pattern, int index, char *out, size_t size);
/** Number of placeholders in pattern; -1 if it is malformed. */
int adcgs_pattern_places(const char *pattern);

#endif
