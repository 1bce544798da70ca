/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --check and --repair: what is wrong with a stream, and what of it can be saved. */
#ifndef ADCGS_TOOLS_INFO_CHECK_H
#define ADCGS_TOOLS_INFO_CHECK_H

#include "stream/stream.h"

/**
 * Read what a path or a URL names, print a line for each fault and one of what can be used, and, unless repaired is NULL, write
 * that there as a stream that is whole. *faults: how many there were.
 */
adcgs_status adcgs_info_check(const char *path, const char *repaired, uint32_t *faults, adcgs_error *error);

#endif
