/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Median of numbers. */
#ifndef ADCGS_SYSTEM_MEDIAN_H
#define ADCGS_SYSTEM_MEDIAN_H

#include <stddef.h>

/** Sorts values, [n], and returns the one in the middle, the upper one of two. n is at least 1, no value is NaN. */
double adcgs_median(double *values, size_t n);

#endif
