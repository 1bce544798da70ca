/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Median of numbers. */
#include "config.h"

#include "system/median.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double adcgs_median(double *values, size_t n)
{
    qsort(values, n, sizeof *values, compare);
    return values[n / 2];
}
