/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A stream being read, chunk by chunk: what those who read it from end to end and those who seek in it share. */
#ifndef ADCGS_STREAM_READER_H
#define ADCGS_STREAM_READER_H

#include "stream/segment.h"

typedef struct adcgs_stream_reader {
    adcgs_stream *stream;
    const adcgs_read_options *options; /**< outlive the reader */
    adcgs_source source;
    adcgs_syn_head head;
    uint8_t *head_payload;  /**< to compare repetitions with; NULL before HEAD */
    size_t head_bytes;
    adcgs_net_table nets;
    adcgs_segment segment;
    int indexed, ended;     /**< INDX, ENDC were read */
    int joined;             /**< in the middle: what INDX and ENDC say of the whole cannot be checked */
    uint32_t crc_of_crcs;   /**< over the chunks before the current one */
    adcgs_trace_fn trace;
    void *trace_user;
    adcgs_error *error;
} adcgs_stream_reader;

/** stream was initialised; error receives what fails, and outlives the reader. */
void adcgs_stream_reader_init(adcgs_stream_reader *reader, adcgs_stream *stream, adcgs_read_fn read, void *user,
                              const adcgs_read_options *options, adcgs_error *error);
void adcgs_stream_reader_clear(adcgs_stream_reader *reader);

/** Segments that were read, also those that are not kept. */
uint32_t adcgs_stream_reader_segments(const adcgs_stream_reader *reader);
adcgs_status adcgs_stream_reader_signature(adcgs_stream_reader *reader);
/** All that is left to read, the signature too if that was not yet read; what ends early is used as far as it goes. */
adcgs_status adcgs_stream_reader_rest(adcgs_stream_reader *reader);
/** Read a chunk and use it. *truncated: the stream ended inside, or before it. */
adcgs_status adcgs_stream_reader_chunk(adcgs_stream_reader *reader, int *truncated);

#endif
