/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Loops of one kind of instruction in plain C. */
#include "ceilings.h"

enum { CHAINS = 40 }; /* products and sums, possibly vectorised by four; without multiply-add */

static double fma_loop(int times, double *operations)
{
    float chain[CHAINS], sum = 0;
    for (int c = 0; c < CHAINS; c++)
        chain[c] = (float)c;
    for (int i = 0; i < times; i++)
        for (int c = 0; c < CHAINS; c++)
            chain[c] = chain[c] * 0.999f + 0.5f;
    for (int c = 0; c < CHAINS; c++)
        sum += chain[c];
    *operations = 2.0 * CHAINS * times;
    return (double)sum;
}

static double read_loop(const float *from, size_t n)
{
    float sum[16] = {0};
    for (size_t i = 0; i < n; i += 16)
        for (size_t j = 0; j < 16; j++)
            sum[j] += from[i + j];
    for (int j = 1; j < 16; j++)
        sum[0] += sum[j];
    return (double)sum[0];
}

const bench_loops bench_loops_scalar = {fma_loop, NULL, read_loop};
