/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sorting of numbers. */
#include "system/sort_values.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void adcgs_sort(double *values, size_t n)
{
    qsort(values, n, sizeof *values, compare);
}
