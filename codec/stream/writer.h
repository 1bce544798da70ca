/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream being written, chunk by chunk: what those who have all of it and those whose stream grows share. */
#ifndef ADCGS_STREAM_WRITER_H
#define ADCGS_STREAM_WRITER_H

#include "stream/parts.h"

typedef struct adcgs_writer {
    adcgs_stream *stream;   /**< what is true of all segments; receives bytes and weights */
    uint32_t max_anchors;   /**< of any segment */
    adcgs_buffer *out;
    size_t begin;           /**< in out, of what of the stream is there */
    uint64_t gone;          /**< bytes of the stream before these */
    const adcgs_level *limits;
    uint32_t crc_of_crcs;
    uint32_t n_nets;        /**< written so far */
    uint64_t weights;
    adcgs_cost spent;       /**< of the level's model bytes and work */
    uint32_t n_segments;    /**< written so far */
    adcgs_syn_index last;   /**< the segment written last, but for its bytes */
    adcgs_buffer index;     /**< payload of INDX of those before it, less the count */
    adcgs_error *error;
} adcgs_writer;

/** stream->level is set; error receives what fails, and outlives the writer, as stream and out do. */
void adcgs_writer_init(adcgs_writer *writer, adcgs_stream *stream, uint32_t max_anchors, adcgs_buffer *out, adcgs_error *error);
void adcgs_writer_clear(adcgs_writer *writer);

/** Signature, HEAD, cameras and metadata. */
adcgs_status adcgs_writer_front(adcgs_writer *writer);
/** HEAD, once more. */
adcgs_status adcgs_writer_head(adcgs_writer *writer);
/** The next segment, which was checked; before: of which it is predicted, or NULL. */
adcgs_status adcgs_writer_segment(adcgs_writer *writer, const adcgs_model *before, adcgs_model *model);
/** INDX, where there are several segments, and ENDC. */
adcgs_status adcgs_writer_end(adcgs_writer *writer);

/** Whether a stream without its segments can be written. */
adcgs_status adcgs_writer_check_head(const adcgs_stream *stream, adcgs_error *error);
/**
 * Whether a segment can be the stream's i-th, behind one that has this model (NULL: it is not known, or there is none) and these
 * ticks, which become its own. ADCGS_ERR_USAGE if not.
 */
adcgs_status adcgs_writer_check(const adcgs_stream *stream, uint32_t i, const adcgs_model *before, const adcgs_model *model,
                                int64_t span[2], adcgs_error *error);

#endif
