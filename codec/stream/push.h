/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream whose bytes arrive over time, in pieces of any size. Each chunk is used when its last byte has arrived. The part of a
 * segment that is decoded by then can be inspected. The final result equals that of reading in order.
 *
 * With options->tune_in the beginning may be missing. Bytes that are no signature are skipped up to the next HEAD, and the chunks
 * after it up to the next key. stream->first_segment is then the number of that segment.
 */
#ifndef ADCGS_STREAM_PUSH_H
#define ADCGS_STREAM_PUSH_H

#include "stream/stream.h"

typedef struct adcgs_push_reader adcgs_push_reader;

/**
 * stream is initialised and owned by the caller and receives the contents. options is copied; the objects that it points to must
 * outlive the reader.
 */
adcgs_status adcgs_push_create(adcgs_push_reader **out, adcgs_stream *stream, const adcgs_read_options *options,
                               adcgs_error *error);
void adcgs_push_free(adcgs_push_reader **reader);

/**
 * Take bytes, at most up to the end of the current chunk: *used. At the end of the stream none are taken. A failure is final: all
 * later calls fail, too.
 */
adcgs_status adcgs_push_take(adcgs_push_reader *reader, const uint8_t *data, size_t bytes, size_t *used, adcgs_arrival *arrived,
                             adcgs_error *error);
/** No more bytes will come. The received part of the last chunk is used, as when reading in order ends early. */
adcgs_status adcgs_push_finish(adcgs_push_reader *reader, adcgs_error *error);
/** Read a sequential source like adcgs_push_take(), to the end of the stream and not beyond. */
adcgs_status adcgs_push_read(adcgs_stream *stream, adcgs_read_fn read, void *user, const adcgs_read_options *options,
                             adcgs_error *error);
/** Whether HEAD has been received. */
int adcgs_push_has_head(const adcgs_push_reader *reader);
/** Progress of receiving a stream. */
typedef struct adcgs_push_progress {
    int is_over; /**< the stream is complete, or no more bytes will come */
    uint64_t bytes;
    int64_t start;             /**< tick at which the first segment begins; before it has begun, the value in HEAD */
    int64_t end;               /**< tick, from HEAD; INT64_MAX: not given */
    int64_t committed;         /**< tick before which content no longer changes; INT64_MIN: all may, INT64_MAX: nothing will */
    int64_t available;         /**< tick at which the renderable content ends; INT64_MIN: none */
    uint32_t segments;         /**< complete segments, including those freed */
    uint32_t total;            /**< from HEAD; 0: not given */
    int tiers, tiers_received; /**< of the segment being received; 0: none */
} adcgs_push_progress;
/** Only after HEAD has been received. */
void adcgs_push_get_progress(const adcgs_push_reader *reader, adcgs_push_progress *progress);

/**
 * A copy of the current segment as far as it has been received, if it can be rendered (*drawable). The caller clears it with the
 * options' memory.
 */
adcgs_status adcgs_push_peek(const adcgs_push_reader *reader, adcgs_model *model, int *drawable, adcgs_error *error);

#endif
