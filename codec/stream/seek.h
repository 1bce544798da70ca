/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream of which segments are read when they are wanted, from bytes at any position (spec clause "Seeking"): the header once,
 * the index or else the headers of chunks, and then a segment with what it is predicted from. One segment is in memory at a time,
 * or two where one fades into the other.
 */
#ifndef ADCGS_STREAM_SEEK_H
#define ADCGS_STREAM_SEEK_H

#include "stream/stream.h"

typedef struct adcgs_seek adcgs_seek;

/**
 * Read the header and find the segments; stream, initialised by the caller and owned by it, receives the header, cameras and
 * metadata that stand before the first segment, and from then on the segments at hand, if any. options is copied; what it points
 * to outlives the seeker. ADCGS_ERR_TRUNCATED if the stream ends before ENDC: nothing can be said of it without reading it all.
 */
adcgs_status adcgs_seek_open(adcgs_seek **out, adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                             const adcgs_read_options *options, adcgs_error *error);
void adcgs_seek_free(adcgs_seek **seek);

/** Segments of the stream, and the ticks of one of them: its start, its end, its reach. */
uint32_t adcgs_seek_segments(const adcgs_seek *seek);
void adcgs_seek_times(const adcgs_seek *seek, uint32_t number, int64_t ticks[3]);
/** Bytes that were read so far. */
uint64_t adcgs_seek_bytes(const adcgs_seek *seek);

/** A segment's model, if it is in memory; else NULL. */
const adcgs_model *adcgs_seek_at_hand(const adcgs_seek *seek, uint32_t number);
/**
 * Bring a segment into memory, which is not there, or with before nonzero it and the one in front of it, which are not both
 * there; those that were there may be gone or moved, whatever this returns.
 */
adcgs_status adcgs_seek_to(adcgs_seek *seek, uint32_t number, int before, adcgs_error *error);

#endif
