/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What can be used of a stream that is damaged. Chunks are found again behind what is none; a layer goes as far as its slices are
 * whole, and is concealed from there; a segment without its base layer is lost, with those that are predicted from it, up to the
 * next that is not.
 */
#ifndef ADCGS_STREAM_SALVAGE_H
#define ADCGS_STREAM_SALVAGE_H

#include "stream/stream.h"

/** Most bytes of a stream whose level is unknown: those of level 2. */
#define ADCGS_SALVAGE_BYTES (UINT64_C(256) << 20)
/**
 * The most bytes of a stream that begins with these: the bound of its level, or ADCGS_SALVAGE_BYTES if its HEAD is damaged or
 * not complete.
 */
uint64_t adcgs_salvage_bytes(const uint8_t *data, size_t bytes);

/**
 * Read what is whole. Each fault is a warning of options->log, one line with its place; *faults: how many there were, 0 for a
 * stream that nothing is wrong with, which then is as adcgs_stream_read() gives it. ADCGS_ERR_DATA if no segment can be used,
 * ADCGS_ERR_UNSUPPORTED and ADCGS_ERR_LIMIT as there: what is meant otherwise is no damage.
 */
adcgs_status adcgs_stream_salvage(adcgs_stream *stream, adcgs_read_at_fn read, void *user, uint64_t size,
                                  const adcgs_read_options *options, uint32_t *faults, adcgs_error *error);

#endif
