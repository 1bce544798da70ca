/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Recovery of the intact parts of a damaged stream. The search finds chunks again after damaged bytes. A layer is used as far as
 * its slices are intact, and concealed from there on. A segment without its base layer is lost, with all segments that are
 * predicted from it, up to the next one that is not predicted.
 */
#ifndef ADCGS_STREAM_SALVAGE_H
#define ADCGS_STREAM_SALVAGE_H

#include "stream/stream.h"

/** Maximum size of a stream whose level is unknown, in bytes: that of level 2. */
#define ADCGS_SALVAGE_BYTES (UINT64_C(256) << 20)
/**
 * Maximum size in bytes of a stream that begins with these bytes: the bound of its level, or ADCGS_SALVAGE_BYTES if its HEAD is
 * damaged or incomplete.
 */
uint64_t adcgs_salvage_bytes(const uint8_t *data, size_t bytes);

/**
 * Read the intact parts. Each fault is reported to options->log as a warning, one line with its position. *faults: their number.
 * An intact stream gives 0 and the same result as adcgs_stream_read(). ADCGS_ERR_DATA if no segment can be used. Features and
 * sizes that the decoder does not support are no damage: ADCGS_ERR_UNSUPPORTED and ADCGS_ERR_LIMIT as there.
 */
adcgs_status adcgs_stream_salvage(adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                                  const adcgs_read_options *options, uint32_t *faults, adcgs_error *error);

#endif
