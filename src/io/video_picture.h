/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A decoded picture as an image: RGB by the stream's matrix and range, computed
 * here in binary32 from samples of any depth (libswscale's results of more than
 * 8 bits are up to a level of 8 bits too dark), pixels made square, turned.
 */
#ifndef ADCGS_IO_VIDEO_PICTURE_H
#define ADCGS_IO_VIDEO_PICTURE_H

#include "io/image.h"

#include <libavutil/frame.h>

typedef struct adcgs_video_view {
    AVRational aspect;     /**< width of a pixel over its height; 0 or less: square */
    const int32_t *matrix; /**< that turns the picture; NULL: it stands */
} adcgs_video_view;

/**
 * Chroma is interpolated linearly between its samples, from where the stream says that they are (left if it does not say).
 * name stands for the picture in messages. ADCGS_ERR_UNSUPPORTED for kinds of samples and matrices that are not known, and for
 * turns by other than right angles.
 */
adcgs_status adcgs_video_picture(adcgs_image *out, const AVFrame *frame, const adcgs_video_view *view, const char *name,
                                 adcgs_error *error);

#endif
