/* SPDX-License-Identifier: BSD-2-Clause */
/** \file State of writing a stream chunk by chunk, shared by complete and growing streams. */
#ifndef ADCGS_STREAM_WRITER_H
#define ADCGS_STREAM_WRITER_H

#include "stream/parts.h"

typedef struct adcgs_writer {
    adcgs_stream *stream; /**< properties of all segments; receives bytes and weights */
    uint32_t max_anchors; /**< maximum over the segments */
    adcgs_buffer *out;
    size_t begin;  /**< position in out at which the stream's bytes begin */
    uint64_t gone; /**< bytes of the stream before begin */
    const adcgs_level *limits;
    uint32_t crc_of_crcs;
    uint32_t n_nets; /**< written so far */
    uint64_t weights;
    adcgs_cost spent;     /**< used model bytes and work of the level */
    uint32_t n_segments;  /**< written so far */
    adcgs_syn_index last; /**< the last segment written, without its bytes */
    adcgs_buffer index;   /**< payload of INDX for the segments before it, without the count */
    adcgs_error *error;
} adcgs_writer;

/** stream->level is set. error receives failures. error, stream and out must outlive the writer. */
void adcgs_writer_init(adcgs_writer *writer, adcgs_stream *stream, uint32_t max_anchors, adcgs_buffer *out, adcgs_error *error);
void adcgs_writer_clear(adcgs_writer *writer);

/** Signature, HEAD, cameras and metadata. */
adcgs_status adcgs_writer_front(adcgs_writer *writer);
/** HEAD again. */
adcgs_status adcgs_writer_head(adcgs_writer *writer);
/** The next segment, already checked. before: the model that it is predicted from, or NULL. */
adcgs_status adcgs_writer_segment(adcgs_writer *writer, const adcgs_model *before, adcgs_model *model);
/** INDX, if there are several segments, and ENDC. */
adcgs_status adcgs_writer_end(adcgs_writer *writer);

/** Check that a stream can be written, apart from its segments. */
adcgs_status adcgs_writer_check_head(const adcgs_stream *stream, adcgs_error *error);
/**
 * Check that a segment can be the stream's i-th. before: the model of the previous segment; NULL if unknown or none. span: ticks
 * of the previous segment, replaced by its own. ADCGS_ERR_USAGE if not.
 */
adcgs_status adcgs_writer_check(const adcgs_stream *stream, uint32_t i, const adcgs_model *before, const adcgs_model *model,
                                int64_t span[2], adcgs_error *error);

#endif
