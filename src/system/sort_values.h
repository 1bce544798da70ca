/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sorting of numbers, for medians and percentiles. */
#ifndef ADCGS_SYSTEM_SORT_VALUES_H
#define ADCGS_SYSTEM_SORT_VALUES_H

#include <stddef.h>

/** Sorts in ascending order; values must not contain NaN. */
void adcgs_sort(double *values, size_t n);

#endif
