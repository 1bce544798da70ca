/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Measurement on a shared machine. Compared items take turns, and each turn is long enough for the clock. The report has the
 * median of many turns, the 10 % and 90 % percentiles, and the median of the ratios within each turn. Items with one thread are
 * timed by processor time, items with several by elapsed time.
 */
#ifndef ADCGS_BENCH_MEASURE_H
#define ADCGS_BENCH_MEASURE_H

#include "base/cpu_detect.h"
#include "base/thread_pool.h"

#include <stdio.h>

/** The machine's limits, in operations or bytes a second; 0 if a level has no such instruction. */
typedef struct bench_ceilings {
    double fma;     /**< binary32 operations, two for each multiply-add */
    double int16;   /**< integer operations on 16-bit numbers with sums of 32 bits, two for each multiply-add */
    double read[4]; /**< bytes read from the first, second, third cache and memory */
} bench_ceilings;

typedef struct bench {
    FILE *csv;        /**< or NULL */
    int rounds;       /**< turns of each item */
    double turn;      /**< least duration of a turn, in seconds */
    const char *only; /**< groups whose name begins with this, or NULL */
    adcgs_cpu_level level;
    int threads;                /**< at most */
    bench_ceilings ceilings[2]; /**< of one thread, and of all threads */
} bench;

/** An item to measure. */
typedef struct bench_item {
    const char *name;
    void (*run)(void *arg);
    void *arg;
    double work;      /**< amount done by one run */
    const char *unit; /**< of work */
    double cost;      /**< binary32 operations for a unit of work; negative: 16-bit integer operations; 0: unknown */
} bench_item;

/** Conditions of the measurement of a group. Zero leaves a column empty. */
typedef struct bench_place {
    const char *group;
    int width, height;
    uint32_t anchors, splats;
    int threads;
} bench_place;

/** True if a group with this prefix is selected. */
int bench_wants(const bench *b, const char *beginning);
/** Next number of threads: after one follows the maximum. */
static inline int bench_more_threads(const bench *b, int threads)
{
    return threads < b->threads ? b->threads : threads + 1;
}
/**
 * Measures items in turns and prints a line for each. The ceilings of one thread take turns, too, since other load on the machine
 * changes them. With more threads the ceilings found at the start are used. compare: also print, for all items but the first, the
 * median over turns of the ratio of their time to the first's.
 */
void bench_group(const bench *b, const bench_place *place, const bench_item *items, int n, int compare);
/** Prints the names of the columns. */
void bench_header(const bench *b);
/** Exits with a message if status is an error. */
void bench_check(adcgs_status status, const adcgs_error *error);
/** Allocates n numbers, zeroed and aligned to 64 bytes. */
float *bench_floats(size_t n);

#endif
