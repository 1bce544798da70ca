/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The shape of a video's pictures: pixels made square, pictures turned upright. */
#ifndef ADCGS_IO_VIDEO_SHAPE_H
#define ADCGS_IO_VIDEO_SHAPE_H

#include "io/image.h"

#include <libavutil/rational.h>

/** Stretch the side that is too short, linearly; *image is replaced unless pixels are square. aspect as in adcgs_video_view. */
adcgs_status adcgs_video_square(adcgs_image *image, AVRational aspect, const char *name, adcgs_error *error);
/** Turn and mirror by a matrix of ISO 14496-12 (NULL: not at all); *image is replaced. */
adcgs_status adcgs_video_turn(adcgs_image *image, const int32_t *matrix, const char *name, adcgs_error *error);

#endif
