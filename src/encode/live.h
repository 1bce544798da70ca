/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From runs that end one after the other to a stream that grows (stream/grow.h). What it grows by is decoded before anybody sees
 * it, as one who reads from the beginning would, and compared.
 */
#ifndef ADCGS_ENCODE_LIVE_H
#define ADCGS_ENCODE_LIVE_H

#include "encode/encode.h"
#include "stream/grow.h"

typedef struct adcgs_encode_live {
    adcgs_stream front;   /**< what is true of all segments */
    adcgs_grow *grow;
    adcgs_stream back;    /**< as it is read */
    struct adcgs_push_reader *reader;
    adcgs_model model;    /**< of the segment written last; n 0: none */
    uint32_t max_anchors;
} adcgs_encode_live;

/**
 * A stream without segments. whole: the scene by its first segment; cuts: seconds of its time, of which those of all segments are
 * multiples or nearly so. max_anchors: that HEAD has room for. On failure, too, adcgs_encode_live_clear().
 */
adcgs_status adcgs_encode_live_open(adcgs_encode_live *live, const adcgs_scene *whole, const adcgs_cuts *cuts,
                                    uint32_t max_anchors, const adcgs_encode_note *notes, uint32_t n_notes, adcgs_cpu_level cpu,
                                    adcgs_pool *pool, adcgs_error *error);
/**
 * One that goes on: `past` is what is true of all segments of another, which becomes this one's; what it has of segments stays
 * the caller's. Its segments are added as others are, and are then what they were.
 */
adcgs_status adcgs_encode_live_go_on(adcgs_encode_live *live, adcgs_stream *past, uint32_t max_anchors, adcgs_cpu_level cpu,
                                     adcgs_pool *pool, adcgs_error *error);
/** Whether its cameras are those of a scene: ADCGS_ERR_USAGE, naming one that is not. */
adcgs_status adcgs_encode_live_check(const adcgs_encode_live *live, const adcgs_scene *scene, adcgs_error *error);
/**
 * Append a segment's bytes to out; the model, of adcgs_encode_model() with the stream's front, is moved here. When the stream is
 * full (ADCGS_ERR_LIMIT) it stays the caller's, as it was. The first, if it is predicted, becomes a key.
 */
adcgs_status adcgs_encode_live_add(adcgs_encode_live *live, adcgs_model *model, adcgs_buffer *out, adcgs_error *error);
/** The end, of which no more can be added. */
adcgs_status adcgs_encode_live_end(adcgs_encode_live *live, adcgs_buffer *out, adcgs_error *error);
void adcgs_encode_live_clear(adcgs_encode_live *live);

#endif
