/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rendered frames in FFmpeg's formats: RGB of full range, or BT.709 of limited
 * range with chroma at the left of luma; 8 to 16 bits per sample; straight
 * alpha of full range.
 */
#ifndef ADCGS_MEDIA_VIDEO_VIDEO_PLANES_H
#define ADCGS_MEDIA_VIDEO_VIDEO_PLANES_H

#include "base/base.h"

#include <adcgs/types.h>

#include <libavutil/frame.h>

/** True if frames can be converted to this format. */
int adcgs_video_planes_take(enum AVPixelFormat format);
/**
 * Fill an AVFrame of such a format, at least as large as from; additional rows and columns repeat the last one. With alpha, which
 * may be NULL, the colours of from are premultiplied.
 */
adcgs_status adcgs_video_planes(AVFrame *to, const adcgs_frame *from, const float *alpha, adcgs_error *error);

#endif
