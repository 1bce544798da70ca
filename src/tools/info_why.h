/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --why: why a stream has as many bytes as it has. */
#ifndef ADCGS_TOOLS_INFO_WHY_H
#define ADCGS_TOOLS_INFO_WHY_H

#include "tools/info_report.h"

/**
 * On standard output: what the bytes are spent on, and what the encoder says of how it came to that in the stream's metadata
 * ("decisions": see train/decisions.h; of the first segment). What others have written there is not believed further than it is
 * numbers.
 */
void adcgs_info_why(const adcgs_info_report *report, const char *name);

#endif
