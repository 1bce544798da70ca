/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Codebooks by Lloyd's iterations. Prefix sums over the sorted values give the means. */
#include "config.h"

#include "media/splats/codebook.h"

#include <math.h>
#include <stdlib.h>

#define ITERATIONS 40 /* of Lloyd's algorithm; chosen by hand, not measured */

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/** Number of sorted values below limit. */
static size_t count_below(const float *values, size_t n, double limit)
{
    size_t low = 0, high = n;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if ((double)values[middle] < limit)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/** One iteration. sums[i]: sum of the first i values. A centre without values stays. */
static void move_centres(float book[ADCGS_CODEBOOK], const float *values, const double *sums, size_t n)
{
    size_t begin = 0;
    for (int k = 0; k < ADCGS_CODEBOOK; k++) {
        const double limit = k + 1 < ADCGS_CODEBOOK ? 0.5 * ((double)book[k] + (double)book[k + 1]) : INFINITY;
        const size_t end = count_below(values, n, limit);
        if (end > begin) {
            book[k] = (float)((sums[end] - sums[begin]) / (double)(end - begin));
            begin = end;
        }
    }
}

int adcgs_codebook_make(float book[ADCGS_CODEBOOK], float *values, size_t n)
{
    double *const sums = malloc((n + 1) * sizeof *sums);
    if (!sums)
        return 0;
    qsort(values, n, sizeof *values, compare);
    sums[0] = 0.0;
    for (size_t i = 0; i < n; i++)
        sums[i + 1] = sums[i] + (double)values[i];
    /* Start half way between equal counts and equal distances: many values lie close together, and a few are far out. */
    for (int k = 0; k < ADCGS_CODEBOOK; k++) {
        const double share = (k + 0.5) / ADCGS_CODEBOOK, span = (double)values[n - 1] - (double)values[0];
        book[k] = (float)(0.5 * ((double)values[(size_t)(share * (double)n)] + (double)values[0] + share * span));
    }
    for (int i = 0; i < ITERATIONS; i++)
        move_centres(book, values, sums, n);
    free(sums);
    return 1;
}

uint8_t adcgs_codebook_find(const float book[ADCGS_CODEBOOK], float value)
{
    const size_t above = count_below(book, ADCGS_CODEBOOK, (double)value);
    if (above == 0 || (above < ADCGS_CODEBOOK && book[above] - value < value - book[above - 1]))
        return (uint8_t)above;
    return (uint8_t)(above - 1);
}
