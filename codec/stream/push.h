/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream whose bytes come when they come, any number at a time. Each chunk is used when its last byte is there; what a segment
 * has by then can be looked at. What results in the end is what reading in order gives.
 *
 * With options->join the beginning may be missing: bytes that are no signature are passed over up to the next HEAD, and chunks
 * behind that up to the next key. stream->first_segment is then the number of that segment.
 */
#ifndef ADCGS_STREAM_PUSH_H
#define ADCGS_STREAM_PUSH_H

#include "stream/stream.h"

typedef struct adcgs_push_reader adcgs_push_reader;

/** stream, initialised by the caller and owned by it, receives what comes. options is copied; what it points to outlives this. */
adcgs_status adcgs_push_create(adcgs_push_reader **out, adcgs_stream *stream, const adcgs_read_options *options,
                               adcgs_error *error);
void adcgs_push_free(adcgs_push_reader **reader);

/**
 * Take bytes, those to the end of the chunk at hand at most: *used. At the end of the stream none are taken. A failure is final:
 * the next call fails as well.
 */
adcgs_status adcgs_push_take(adcgs_push_reader *reader, const uint8_t *data, size_t bytes, size_t *used, adcgs_arrival *arrived,
                             adcgs_error *error);
/** No more will come: what of the last chunk is there is used, as reading in order does when a stream ends. */
adcgs_status adcgs_push_finish(adcgs_push_reader *reader, adcgs_error *error);
/** All of a sequential source, read as adcgs_push_take() would take it, to the end of the stream and not beyond. */
adcgs_status adcgs_push_read(adcgs_stream *stream, adcgs_read_fn read, void *user, const adcgs_read_options *options,
                             adcgs_error *error);
/** Whether HEAD has come. */
int adcgs_push_has_head(const adcgs_push_reader *reader);
/** How much of a stream has come. */
typedef struct adcgs_push_progress {
    int is_over;            /**< all of it, or no more will */
    uint64_t bytes;
    int64_t start;          /**< tick at which the first segment begins, or before that has come what HEAD says */
    int64_t end;            /**< tick, by HEAD; INT64_MAX: it does not say */
    int64_t final;          /**< tick before which nothing changes any more; INT64_MIN: everything may, INT64_MAX: nothing will */
    int64_t drawable;       /**< tick at which what can be drawn ends; INT64_MIN: nothing can */
    uint32_t segments;      /**< complete ones, also if they were forgotten */
    uint32_t promised;      /**< by HEAD; 0: it does not say */
    int tiers, tiers_drawable; /**< of the segment at hand; 0: there is none */
} adcgs_push_progress;
/** Once HEAD has come. */
void adcgs_push_tell(const adcgs_push_reader *reader, adcgs_push_progress *progress);

/**
 * The segment at hand as far as it has come, if it can be drawn (*drawable): a model of its own, which the caller clears with the
 * options' memory.
 */
adcgs_status adcgs_push_peek(const adcgs_push_reader *reader, adcgs_model *model, int *drawable, adcgs_error *error);

#endif
