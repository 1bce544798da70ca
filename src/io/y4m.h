/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Writing Y4M (YUV4MPEG2): 4:4:4, 8 bit, BT.709 matrix, limited range (Y from
 * 16 to 235, Cb and Cr from 16 to 240).
 *
 * The format has no field for the matrix; players guess it from the size.
 * Say BT.709 to them where they ask (FFmpeg: -colorspace bt709).
 */
#ifndef ADCGS_IO_Y4M_H
#define ADCGS_IO_Y4M_H

#include "base/base.h"

#include <adcgs/camera.h>

#include <stdio.h>

/** Failures of the stream show in ferror(). */
void adcgs_y4m_write_header(FILE *file, int width, int height, double frame_rate);
adcgs_status adcgs_y4m_write_frame(FILE *file, const adcgs_frame *frame, adcgs_error *error);

#endif
