/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Where rendered frames go: numbered images, a video file, Y4M, raw pixels, or
 * nowhere. Files appear complete or not at all; "-" is standard output.
 */
#ifndef ADCGS_IO_SINK_H
#define ADCGS_IO_SINK_H

#include "io/video.h"

#include <adcgs/types.h>

typedef struct adcgs_sink adcgs_sink;

typedef enum adcgs_depth {
    ADCGS_DEPTH_DEFAULT, /**< EXR: half; everything else: 8 bit */
    ADCGS_DEPTH_HALF,    /**< EXR only */
    ADCGS_DEPTH_FLOAT,   /**< EXR and raw only */
    ADCGS_DEPTH_16       /**< PNG, TIFF and PPM only */
} adcgs_depth;

typedef struct adcgs_sink_config {
    const char *target;  /**< "-", a file, or for images a pattern with %d or %04d */
    const char *format;  /**< NULL: by the target's extension, Y4M for "-"; else y4m, raw, null, what images end in, whatever
                              these do, or an extension that a video must have */
    adcgs_depth depth;
    int linear;          /**< EXR only: colours in linear light */
    double frame_rate;   /**< for Y4M and videos */
    int width, height;
    int frames;          /**< how many will come; more than one image needs a pattern */
    int has_alpha;       /**< frames come with alpha, which EXR, PNG, TIFF and some videos take */
    const adcgs_video_style *video; /**< how a video is coded, but for alpha; NULL: as its container has it */
    int has_z;           /**< frames come with depth, which EXR takes */
} adcgs_sink_config;

/** What may come with a frame besides its colours. */
typedef struct adcgs_sink_extras {
    const float *alpha;         /**< [height][width]; the colours are premultiplied by it, without background. NULL: none */
    const float *depth;         /**< [height][width], for EXR's channel Z. NULL: none */
    const adcgs_camera *camera; /**< for EXR's attributes. NULL: none */
    double time;                /**< seconds, with a camera */
} adcgs_sink_extras;

/** The strings of config must outlive the sink. */
adcgs_status adcgs_sink_open(adcgs_sink **out, const adcgs_sink_config *config, adcgs_error *error);
/** The size of the pictures as they are stored: that of the frames, but for videos whose codec takes even sizes only. */
void adcgs_sink_size(const adcgs_sink *sink, int *width, int *height);
/** index numbers the image in a pattern. */
adcgs_status adcgs_sink_write(adcgs_sink *sink, const adcgs_frame *frame, int index, adcgs_error *error);
/** As adcgs_sink_write(), with all that the configuration announced; outputs without attributes leave camera and time out. */
adcgs_status adcgs_sink_write_with(adcgs_sink *sink, const adcgs_frame *frame, const adcgs_sink_extras *extras, int index,
                                   adcgs_error *error);
/** Complete the output. *sink may be NULL. */
adcgs_status adcgs_sink_close(adcgs_sink **sink, adcgs_error *error);
/** Give up: a file not yet complete disappears. *sink may be NULL. */
void adcgs_sink_abort(adcgs_sink **sink);

/** Put index in the place of the one %d, %Nd or %0Nd of pattern; "%%" is a percent sign. -1 if the pattern is malformed. */
int adcgs_pattern_format(const char *pattern, int index, char *out, size_t size);
/** Places for a number in pattern; -1 if it is malformed. */
int adcgs_pattern_places(const char *pattern);

#endif
