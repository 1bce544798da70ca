/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A decoded frame as an image. RGB is computed by the stream's matrix and
 * range, in binary32 from samples of any depth. (libswscale's results of more
 * than 8 bits are up to a level of 8 bits too dark.) Pixels are made square,
 * and the image is turned upright.
 */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_PICTURE_H
#define ADCGS_MEDIA_VIDEO_VIDEO_PICTURE_H

#include "media/image/image.h"
#include "media/video/hdr.h"

#include <libavutil/frame.h>

typedef struct adcgs_video_view {
    AVRational aspect;     /**< width of a pixel over its height; 0 or less: square */
    const int32_t *matrix; /**< turns the image; NULL: it is upright */
} adcgs_video_view;

/** The dynamic range that a frame declares. */
adcgs_hdr adcgs_video_hdr(const AVFrame *frame);
/**
 * Convert a frame, also one of high dynamic range. Chroma is interpolated linearly between its samples at the positions that the
 * stream declares (by default left). name: the image's name in messages. ADCGS_ERR_UNSUPPORTED for unknown kinds of samples and
 * matrices, and for turns by other than right angles.
 */
adcgs_status adcgs_video_picture(adcgs_image *out, const AVFrame *frame, const adcgs_video_view *view, const char *name,
                                 adcgs_error *error);

#endif
