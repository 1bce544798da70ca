/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream that grows: segment after segment is written when it is there, and how many there will be nobody knows. HEAD says so,
 * and comes again before each key, so that whoever joins finds it. It ends with INDX and ENDC like any other.
 */
#ifndef ADCGS_STREAM_GROW_H
#define ADCGS_STREAM_GROW_H

#include "stream/stream.h"

typedef struct adcgs_grow adcgs_grow;

/**
 * stream: what is true of all segments, with level, params and start_ticks, without segments; it is written to, and outlives
 * this. max_anchors: that any segment may have. ADCGS_ERR_USAGE for what no stream can hold, ADCGS_ERR_LIMIT for what the level
 * cannot.
 */
adcgs_status adcgs_grow_create(adcgs_grow **out, adcgs_stream *stream, uint32_t max_anchors, adcgs_error *error);
void adcgs_grow_free(adcgs_grow **grow);

/**
 * Append the next segment to out, in front of the first the stream's front, in front of every later key HEAD. before: the model
 * of the segment in front of it, which a predicted one needs; else it may be NULL. A failure changes nothing; with
 * ADCGS_ERR_LIMIT the stream is full, and can be ended.
 */
adcgs_status adcgs_grow_segment(adcgs_grow *grow, const adcgs_model *before, adcgs_model *model, adcgs_buffer *out,
                                adcgs_error *error);
/** Append INDX and ENDC to out; there was a segment. */
adcgs_status adcgs_grow_end(adcgs_grow *grow, adcgs_buffer *out, adcgs_error *error);
uint32_t adcgs_grow_segments(const adcgs_grow *grow);

/**
 * The payload of HEAD of the same stream when its end is known, appended to out: of the same length, with the number of segments,
 * the duration, the anchors of the largest and the lowest level that fits.
 */
adcgs_status adcgs_grow_settle(const adcgs_grow *grow, adcgs_buffer *out, adcgs_error *error);

#endif
