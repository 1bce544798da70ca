/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-info --why: explains the size of a stream. */
#ifndef ADCGS_APPS_INFO_INFO_WHY_H
#define ADCGS_APPS_INFO_INFO_WHY_H

#include "apps/info/info_report.h"

/**
 * Prints the distribution of the bytes to standard output, and the encoder's decisions from the stream's metadata ("decisions":
 * see train/state/decisions.h; of the first segment). Metadata of other writers counts only as far as it consists of numbers.
 */
void adcgs_info_why(const adcgs_info_report *report, const char *name);

#endif
