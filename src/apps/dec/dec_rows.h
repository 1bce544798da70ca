/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-dec: rows of splats that are the same splats in all frames. */
#ifndef ADCGS_APPS_DEC_DEC_ROWS_H
#define ADCGS_APPS_DEC_DEC_ROWS_H

#include "camera/path.h"
#include "media/splats/splats.h"

#include <adcgs/decoder.h>

#define ADCGS_DEC_NO_ROW UINT32_MAX /**< row of a slot that is invisible in all frames; definition */

/** Successive frames that one segment serves. */
typedef struct adcgs_dec_span {
    uint32_t segment;
    uint32_t slots;     /**< of the decoder's primitives */
    uint32_t first_row; /**< the rows of earlier segments come first */
    int first, frames;  /**< index of the first frame, and their number */
    uint32_t *row;      /**< [slots]: 0.. within the span, or ADCGS_DEC_NO_ROW */
    adcgs_splats begin; /**< each row in the first frame that shows it, in this order */
} adcgs_dec_span;

/** Rows of a clip: those of its segments, one after another. */
typedef struct adcgs_dec_rows {
    adcgs_dec_span *span;
    size_t n;
    uint32_t total;          /**< rows of all segments */
    double offset[3];        /**< subtracted from positions in the world (media/splats/offset.h) */
    double origin[3], scale; /**< position = origin + scale * scene */
} adcgs_dec_rows;

/** Decodes all frames to find the slots that are visible in any of them. The caller frees *out, also on failure. */
adcgs_status adcgs_dec_rows_find(adcgs_dec_rows *out, adcgs_decoder *decoder, const adcgs_info *info,
                                 const adcgs_camera_path *frames, const char *path, adcgs_error *error);
void adcgs_dec_rows_free(adcgs_dec_rows *rows);
/** The primitives of a frame of a span. ADCGS_ERR_DATA if the segment is another one than before. */
adcgs_status adcgs_dec_rows_at(const adcgs_dec_span *span, adcgs_decoder *decoder, double time, adcgs_primitives *out,
                               const char *path, adcgs_error *error);
/** Receives the rows of a frame. */
typedef adcgs_status (*adcgs_dec_rows_fn)(void *user, int frame, const adcgs_splats *splats, adcgs_error *error);
/**
 * Passes the rows of each frame to take(), in order, until an interrupt. Invisible rows, and those of other spans, have a tiny
 * opacity, and else the values of a frame that shows them.
 */
adcgs_status adcgs_dec_rows_each(const adcgs_dec_rows *rows, adcgs_decoder *decoder, const adcgs_camera_path *frames,
                                 const char *path, adcgs_dec_rows_fn take, void *user, adcgs_error *error);

#endif
