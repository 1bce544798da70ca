/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers in order, for medians and percentiles. */
#ifndef ADCGS_DATA_SORT_H
#define ADCGS_DATA_SORT_H

#include <stddef.h>

/** Ascending; the values are not to hold NaN. */
void adcgs_sort(double *values, size_t n);

#endif
