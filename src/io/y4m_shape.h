/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * How long the frames of a Y4M stream are, by its first line: enough to take it apart as it comes, without looking at pixels.
 */
#ifndef ADCGS_IO_Y4M_SHAPE_H
#define ADCGS_IO_Y4M_SHAPE_H

#include "io/fps.h"

#define ADCGS_Y4M_LINE_MAX 256 /**< bytes of a line, its line feed included */

typedef struct adcgs_y4m_shape {
    int width, height;
    adcgs_fps rate;     /**< not known where the stream does not say */
    size_t frame_bytes; /**< of samples, behind the line that begins with FRAME */
} adcgs_y4m_shape;

/** The first line, ended by a zero instead of its line feed. ADCGS_ERR_DATA, ADCGS_ERR_UNSUPPORTED, naming path. */
adcgs_status adcgs_y4m_shape_parse(adcgs_y4m_shape *out, const char *line, const char *path, adcgs_error *error);

#endif
