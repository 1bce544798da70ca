/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Measurement of the machine's limits. */
#ifndef ADCGS_BENCH_CEILINGS_H
#define ADCGS_BENCH_CEILINGS_H

#include "measure.h"

/** Loops of a single kind of instruction. Each returns a number that depends on all operations. */
typedef struct bench_loops {
    double (*fma)(int times, double *operations);
    double (*int16)(int times, double *operations); /**< NULL if there is none */
    double (*read)(const float *from, size_t n);    /**< n is a multiple of 1024 */
} bench_loops;

extern const bench_loops bench_loops_scalar, bench_loops_avx2, bench_loops_avx512;

/** The loops for a level, in this build. */
const bench_loops *bench_loops_of(adcgs_cpu_level level);
/** Measure and print the ceilings for one thread and for all. */
void bench_find_ceilings(bench *b);

#endif
