/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writing Y4M (YUV4MPEG2): 4:4:4, 8 bit, BT.709 matrix, limited range (Y from
 * 16 to 235, Cb and Cr from 16 to 240).
 *
 * The format has no field for the matrix, so players guess it from the size.
 * Set BT.709 in players with an option for it (FFmpeg: -colorspace bt709).
 */
#ifndef ADCGS_MEDIA_VIDEO_Y4M_H
#define ADCGS_MEDIA_VIDEO_Y4M_H

#include "base/base.h"

#include <adcgs/types.h>

#include <stdio.h>

/** The caller checks the file with ferror(). */
void adcgs_y4m_write_header(FILE *file, int width, int height, double frame_rate);
adcgs_status adcgs_y4m_write_frame(FILE *file, const adcgs_frame *frame, adcgs_error *error);

#endif
