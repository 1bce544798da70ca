/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --bytes: a smaller stream without training again. */
#ifndef ADCGS_APPS_INFO_INFO_CUT_H
#define ADCGS_APPS_INFO_INFO_CUT_H

#include "stream/stream.h"

/**
 * Writes a stream of at most `bytes` bytes. It drops the finest tiers, one after the other, of segments that no other segment
 * needs. ADCGS_ERR_USAGE reports the smallest possible size.
 */
adcgs_status adcgs_info_cut(adcgs_stream *stream, uint64_t bytes, const char *path, adcgs_error *error);

#endif
