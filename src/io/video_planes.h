/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Rendered frames as FFmpeg stores them: RGB of full range, or BT.709 of limited range, chroma beside luma on the left; of 8 to
 * 16 bits a sample; alpha, which is straight, of full range.
 */
#ifndef ADCGS_IO_VIDEO_PLANES_H
#define ADCGS_IO_VIDEO_PLANES_H

#include "base/base.h"

#include <adcgs/types.h>

#include <libavutil/frame.h>

/** Whether frames can be had in that format. */
int adcgs_video_planes_take(enum AVPixelFormat format);
/**
 * Fill a frame of FFmpeg's of such a format, at least as large; what is larger repeats the last row and column. With alpha, which
 * may be NULL, colours come premultiplied by it.
 */
adcgs_status adcgs_video_planes(AVFrame *to, const adcgs_frame *from, const float *alpha, adcgs_error *error);

#endif
