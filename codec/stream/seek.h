/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream of which segments are read when they are wanted, from bytes at any position (spec clause "Seeking"): the header once,
 * the index or else the headers of chunks, and then a segment with what it is predicted from. One segment is in memory at a time.
 */
#ifndef ADCGS_STREAM_SEEK_H
#define ADCGS_STREAM_SEEK_H

#include "stream/stream.h"

typedef struct adcgs_seek adcgs_seek;

/**
 * Read the header and find the segments; stream, initialised by the caller and owned by it, receives the header, cameras and
 * metadata that stand before the first segment, and from then on the segment at hand, if any. options is copied; what it points
 * to outlives the seeker. ADCGS_ERR_TRUNCATED if the stream ends before ENDC: nothing can be said of it without reading it all.
 */
adcgs_status adcgs_seek_open(adcgs_seek **out, adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                             const adcgs_read_options *options, adcgs_error *error);
void adcgs_seek_free(adcgs_seek **seek);

/** Segments of the stream, and the tick at which one of them starts. */
uint32_t adcgs_seek_segments(const adcgs_seek *seek);
int64_t adcgs_seek_start(const adcgs_seek *seek, uint32_t number);
/** Bytes that were read so far. */
uint64_t adcgs_seek_bytes(const adcgs_seek *seek);

/**
 * Bring a segment into memory; the one that was there is gone, whatever this returns. The model is stream->segments[0], until
 * the next call.
 */
adcgs_status adcgs_seek_to(adcgs_seek *seek, uint32_t number, const adcgs_model **model, adcgs_error *error);

#endif
