/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A stream with random access whose segments are read on demand (spec clause "Seeking"). The header is read once, then the index
 * or else the headers of chunks, then each requested segment with the segments that it is predicted from. One segment is in
 * memory at a time, two during a crossfade.
 */
#ifndef ADCGS_STREAM_SEEK_H
#define ADCGS_STREAM_SEEK_H

#include "stream/stream.h"

typedef struct adcgs_seek adcgs_seek;

/**
 * Read the header and find the segments. stream is initialised and owned by the caller. It receives the header, cameras and
 * metadata that precede the first segment, and later the segments in memory, if any. options is copied; the objects that it
 * points to must outlive the seeker. ADCGS_ERR_TRUNCATED if the stream ends before ENDC: such a stream must be read as a whole.
 */
adcgs_status adcgs_seek_open(adcgs_seek **out, adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                             const adcgs_read_options *options, adcgs_error *error);
void adcgs_seek_free(adcgs_seek **seek);

/** Number of segments of the stream, and the ticks of one of them: its start, end and reach. */
uint32_t adcgs_seek_segments(const adcgs_seek *seek);
void adcgs_seek_times(const adcgs_seek *seek, uint32_t number, int64_t ticks[3]);
/** Number of bytes read so far. */
uint64_t adcgs_seek_bytes(const adcgs_seek *seek);

/** A segment's model if it is in memory; else NULL. */
const adcgs_model *adcgs_seek_at_hand(const adcgs_seek *seek, uint32_t number);
/**
 * Bring a segment into memory; if before is nonzero, also the segment before it. The caller has checked that not all of them are
 * in memory. Segments that were in memory may be freed or moved, even on failure.
 */
adcgs_status adcgs_seek_to(adcgs_seek *seek, uint32_t number, int before, adcgs_error *error);

#endif
