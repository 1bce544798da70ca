/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Size of the frames of a Y4M stream, from its first line. That is enough to
 * split the stream as it arrives, without reading pixels.
 */
#ifndef ADCGS_MEDIA_VIDEO_Y4M_SHAPE_H
#define ADCGS_MEDIA_VIDEO_Y4M_SHAPE_H

#include "media/video/fps.h"

#define ADCGS_Y4M_LINE_MAX 256 /**< bytes of a line, line feed included; definition (mjpegtools, Y4M_LINE_MAX) */

typedef struct adcgs_y4m_shape {
    int width, height;
    adcgs_fps rate;     /**< unknown if the stream does not give it */
    size_t frame_bytes; /**< of samples, after the line that begins with FRAME */
} adcgs_y4m_shape;

/** Parse the first line, terminated by a zero instead of its line feed. ADCGS_ERR_DATA, ADCGS_ERR_UNSUPPORTED, naming path. */
adcgs_status adcgs_y4m_shape_parse(adcgs_y4m_shape *out, const char *line, const char *path, adcgs_error *error);

#endif
