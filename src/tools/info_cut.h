/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --bytes: a smaller stream without learning anew. */
#ifndef ADCGS_TOOLS_INFO_CUT_H
#define ADCGS_TOOLS_INFO_CUT_H

#include "stream/stream.h"

/**
 * Write a stream of at most so many bytes: without the finest tiers, one after the other, of the segments that no other needs.
 * ADCGS_ERR_USAGE says how small it can be.
 */
adcgs_status adcgs_info_cut(adcgs_stream *stream, uint64_t bytes, const char *path, adcgs_error *error);

#endif
