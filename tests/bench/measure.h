/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Measuring on a machine that others use as well: things to be compared take turns, each turn long enough for the clock, and
 * what is told of them is the median of many turns, the tenth and the ninetieth percentile, and the median of the ratios
 * within each turn. What one thread does is timed by its share of a processor, what several do by the clock on the wall.
 */
#ifndef ADCGS_BENCH_MEASURE_H
#define ADCGS_BENCH_MEASURE_H

#include "base/cpu.h"
#include "base/pool.h"

#include <stdio.h>

/** What the machine can do at most, operations or bytes a second; 0 where a level has no such instruction. */
typedef struct bench_ceilings {
    double fma;     /**< binary32 operations, two for each multiply-add */
    double int16;   /**< integer operations on 16-bit numbers with sums of 32 bits, two for each multiply-add */
    double read[4]; /**< bytes read from the first, second, third cache and memory */
} bench_ceilings;

typedef struct bench {
    FILE *csv;            /**< or NULL */
    int rounds;           /**< turns of each thing */
    double turn;          /**< seconds that a turn takes at least */
    const char *only;     /**< groups whose name begins with this, or NULL */
    adcgs_cpu_level level;
    int threads;          /**< at most */
    bench_ceilings ceilings[2]; /**< of one thread, and of all */
} bench;

/** Something to be measured. */
typedef struct bench_item {
    const char *name;
    void (*run)(void *arg);
    void *arg;
    double work;      /**< done by one run */
    const char *unit; /**< of the work */
    double cost;      /**< binary32 operations for a unit of work; below 0: 16-bit integer ones; 0: not known */
} bench_item;

/** Where a group is measured. Zero leaves a column empty. */
typedef struct bench_place {
    const char *group;
    int width, height;
    uint32_t anchors, splats;
    int threads;
} bench_place;

/** Whether any group whose name begins so is wanted. */
int bench_wants(const bench *b, const char *beginning);
/** After one thread come all of them. */
static inline int bench_more_threads(const bench *b, int threads)
{
    return threads < b->threads ? b->threads : threads + 1;
}
/**
 * Measure things in turns and print a line for each. Ceilings of one thread take turns too, since what a machine can do changes
 * with what others do on it; with more threads they are those found at the beginning. compare: the others also have the ratio
 * of their time to the first's, median of the turns.
 */
void bench_group(const bench *b, const bench_place *place, const bench_item *items, int n, int compare);
/** Print the columns' names. */
void bench_header(const bench *b);
/** End with a message unless all is well. */
void bench_check(adcgs_status status, const adcgs_error *error);
/** Memory for n numbers, zeroed and aligned to 64 bytes. */
float *bench_floats(size_t n);

#endif
