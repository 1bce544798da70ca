/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rendered frames as planes of 8-bit 4:2:0, BT.709, limited range, chroma beside luma on the left. */
#ifndef ADCGS_IO_VIDEO_PLANES_H
#define ADCGS_IO_VIDEO_PLANES_H

#include "base/base.h"

#include <adcgs/types.h>

#include <libavutil/frame.h>

/** Fill the planes of a frame of FFmpeg's, at least as large; what is larger repeats the last row and column. */
adcgs_status adcgs_video_planes(AVFrame *to, const adcgs_frame *from, adcgs_error *error);

#endif
