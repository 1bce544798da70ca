/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Aspect and orientation of a video's images: pixels are made square, images
 * are turned upright.
 */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_SHAPE_H
#define ADCGS_MEDIA_VIDEO_VIDEO_SHAPE_H

#include "media/image/image.h"

#include <libavutil/rational.h>

/**
 * Stretch the side of the image that is too short, linearly; *image is replaced, except if pixels are square. aspect as in
 * adcgs_video_view.
 */
adcgs_status adcgs_video_square(adcgs_image *image, AVRational aspect, const char *name, adcgs_error *error);
/** Turn and mirror by a matrix of ISO 14496-12 (NULL: no change); *image is replaced. */
adcgs_status adcgs_video_turn(adcgs_image *image, const int32_t *matrix, const char *name, adcgs_error *error);

#endif
