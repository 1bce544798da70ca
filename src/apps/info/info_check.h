/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --check and --repair: faults of a stream and its usable parts. */
#ifndef ADCGS_APPS_INFO_INFO_CHECK_H
#define ADCGS_APPS_INFO_INFO_CHECK_H

#include "stream/stream.h"

/**
 * Reads the stream at a path or URL, and prints a line for each fault and one for the usable parts. If repaired is not NULL,
 * writes the usable parts there as an intact stream. *faults receives the number of faults.
 */
adcgs_status adcgs_info_check(const char *path, const char *repaired, uint32_t *faults, adcgs_error *error);

#endif
