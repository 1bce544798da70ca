/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Makes a growing stream (stream/grow.h) of runs that end one after the other. Each new piece is decoded before it is published,
 * as a reader from the beginning would decode it, and compared.
 */
#ifndef ADCGS_SESSION_LIVE_STREAM_H
#define ADCGS_SESSION_LIVE_STREAM_H

#include "encode/encode.h"
#include "stream/grow.h"

typedef struct adcgs_encode_live {
    adcgs_stream front; /**< values that all segments share */
    adcgs_grow *grow;
    adcgs_stream back; /**< the stream as read back */
    struct adcgs_push_reader *reader;
    adcgs_model model; /**< of the segment written last; n 0: none */
    uint32_t max_anchors;
} adcgs_encode_live;

/**
 * Opens a stream without segments. whole: the scene, as known from its first segment. cuts: sample times in seconds that set the
 * time base; the times of all segments are multiples of its tick, at least nearly. max_anchors: anchors of a segment that HEAD
 * allows. Call adcgs_encode_live_clear() on failure, too.
 */
adcgs_status adcgs_encode_live_open(adcgs_encode_live *live, const adcgs_scene *whole, const adcgs_cuts *cuts,
                                    uint32_t max_anchors, const adcgs_encode_note *notes, uint32_t n_notes, adcgs_cpu_level cpu,
                                    adcgs_pool *pool, adcgs_error *error);
/**
 * Continues an existing stream. `resumed` holds the values that all of its segments share; they move to this stream, while its
 * segments stay the caller's. The caller adds those segments like new ones, and they come out unchanged.
 */
adcgs_status adcgs_encode_live_continue(adcgs_encode_live *live, adcgs_stream *resumed, uint32_t max_anchors, adcgs_cpu_level cpu,
                                        adcgs_pool *pool, adcgs_error *error);
/** Checks that the stream's cameras belong to a scene. ADCGS_ERR_USAGE names one that does not. */
adcgs_status adcgs_encode_live_check(const adcgs_encode_live *live, const adcgs_scene *scene, adcgs_error *error);
/**
 * Appends a segment's bytes to out. The model, from adcgs_encode_model() with the stream's front, is moved here. If the stream is
 * full (ADCGS_ERR_LIMIT), the model stays the caller's, unchanged. The first segment becomes a key, even if it is predicted.
 */
adcgs_status adcgs_encode_live_add(adcgs_encode_live *live, adcgs_model *model, adcgs_buffer *out, adcgs_error *error);
/** Ends the stream; no segment can follow. */
adcgs_status adcgs_encode_live_end(adcgs_encode_live *live, adcgs_buffer *out, adcgs_error *error);
void adcgs_encode_live_clear(adcgs_encode_live *live);

#endif
