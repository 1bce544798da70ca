/* SPDX-License-Identifier: BSD-2-Clause */
/** \file State of reading a stream chunk by chunk, shared by sequential readers and by seeking. */
#ifndef ADCGS_STREAM_READER_H
#define ADCGS_STREAM_READER_H

#include "stream/segment.h"

typedef struct adcgs_stream_reader {
    adcgs_stream *stream;
    const adcgs_read_options *options; /**< must outlive the reader */
    adcgs_source source;
    adcgs_syn_head head;
    uint8_t *head_payload; /**< for comparing repetitions; NULL before HEAD */
    size_t head_bytes;
    adcgs_net_table nets;
    adcgs_segment segment;
    int indexed, ended;   /**< INDX, ENDC were read */
    int joined;           /**< tuned in: the totals in INDX and ENDC cannot be checked */
    uint32_t crc_of_crcs; /**< over the chunks before the current one */
    adcgs_trace_fn trace;
    void *trace_user;
    adcgs_error *error;
} adcgs_stream_reader;

/** The caller has initialised stream. error receives failures and must outlive the reader. */
void adcgs_stream_reader_init(adcgs_stream_reader *reader, adcgs_stream *stream, adcgs_read_fn read, void *user,
                              const adcgs_read_options *options, adcgs_error *error);
void adcgs_stream_reader_clear(adcgs_stream_reader *reader);

/** Number of segments read, including those no longer in memory. */
uint32_t adcgs_stream_reader_segments(const adcgs_stream_reader *reader);
adcgs_status adcgs_stream_reader_signature(adcgs_stream_reader *reader);
/** Read all that is left, including the signature if it was not yet read. A stream that ends early is used as far as it goes. */
adcgs_status adcgs_stream_reader_rest(adcgs_stream_reader *reader);
/** Read a chunk and use it. *truncated: the stream ended inside or before it. */
adcgs_status adcgs_stream_reader_chunk(adcgs_stream_reader *reader, int *truncated);

#endif
