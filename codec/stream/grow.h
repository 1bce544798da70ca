/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream that grows: each segment is written when it is available, and the number of segments is not known in advance. HEAD
 * says so. HEAD is repeated before each key, so that a decoder that tunes in finds it. The stream ends with INDX and ENDC like
 * any other.
 */
#ifndef ADCGS_STREAM_GROW_H
#define ADCGS_STREAM_GROW_H

#include "stream/stream.h"

typedef struct adcgs_grow adcgs_grow;

/**
 * stream: the properties of all segments, with level, params and start_ticks, without segments. The functions write to it, and it
 * must outlive the result. max_anchors: maximum for any segment. ADCGS_ERR_USAGE for values that no stream can hold,
 * ADCGS_ERR_LIMIT for values that the level does not allow.
 */
adcgs_status adcgs_grow_create(adcgs_grow **out, adcgs_stream *stream, uint32_t max_anchors, adcgs_error *error);
void adcgs_grow_free(adcgs_grow **grow);

/**
 * Append the next segment to out. The first segment is preceded by the stream's front, every later key by HEAD. before: the model
 * of the previous segment, required for a predicted segment; else it may be NULL. A failure changes nothing. After
 * ADCGS_ERR_LIMIT the stream is full and can be ended.
 */
adcgs_status adcgs_grow_segment(adcgs_grow *grow, const adcgs_model *before, adcgs_model *model, adcgs_buffer *out,
                                adcgs_error *error);
/** Append INDX and ENDC to out. At least one segment must have been written. */
adcgs_status adcgs_grow_end(adcgs_grow *grow, adcgs_buffer *out, adcgs_error *error);

/**
 * Append to out the payload of HEAD with the values known at the end: the number of segments, the duration, the anchors of the
 * largest segment and the lowest level that fits. It has the length of the payload written before.
 */
adcgs_status adcgs_grow_settle(const adcgs_grow *grow, adcgs_buffer *out, adcgs_error *error);

#endif
