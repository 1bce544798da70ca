/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The limits of the machine. */
#include "config.h"

#include "ceilings.h"

#include <math.h>

/** Bytes that fit into each cache of most machines, and into none. */
static const size_t read_bytes[] = {24 << 10, 384 << 10, 6 << 20, 192 << 20};
static const char *const read_names[] = {"read, first cache", "read, second cache", "read, third cache", "read, memory"};

const bench_loops *bench_loops_of(adcgs_cpu_level level)
{
#ifdef HAVE_AVX512
    if (level == ADCGS_CPU_AVX512)
        return &bench_loops_avx512;
#endif
#ifdef HAVE_AVX2
    if (level == ADCGS_CPU_AVX2)
        return &bench_loops_avx2;
#endif
    return &bench_loops_scalar;
}

enum { FMA, INT16, READ };

/** Approximate number of bytes that each thread reads in a turn. */
#define READ_LEAST ((size_t)256 << 20)

typedef struct job {
    const bench_loops *loops;
    int kind, times;
    const float *from; /**< part of this thread */
    size_t n;
    double operations, sink[256];
} job;

static void run_piece(void *arg, int index, int thread)
{
    (void)thread;
    job *j = arg;
    double operations = 0, sum = 0;
    if (j->kind == FMA)
        sum = j->loops->fma(j->times, &operations);
    else if (j->kind == INT16)
        sum = j->loops->int16(j->times, &operations);
    for (int i = 0; j->kind == READ && i < j->times; i++, operations += (double)j->n * sizeof(float))
        sum += j->loops->read(j->from + (size_t)index * j->n, j->n);
    j->sink[index] = sum;
    if (index == 0)
        j->operations = operations;
}

/** Operations a second of all threads, the best of several turns: a ceiling is measured without disturbance. */
static double best_rate(job *j, adcgs_pool *pool)
{
    const int threads = adcgs_pool_threads(pool);
    double best = 0;
    for (int turn = 0; turn < 9; turn++) {
        const double start = adcgs_seconds();
        adcgs_pool_run(pool, run_piece, j, threads);
        best = fmax(best, threads * j->operations / (adcgs_seconds() - start));
    }
    return best;
}

static void find(bench *b, adcgs_pool *pool, bench_ceilings *c, const float *memory)
{
    job j = {.loops = bench_loops_of(b->level), .kind = FMA, .times = 1 << 21};
    const int threads = adcgs_pool_threads(pool);
    c->fma = best_rate(&j, pool);
    printf("  %-29s %7.1f G operations/s\n", "multiply-add, binary32", 1e-9 * c->fma);
    j.kind = INT16;
    if (j.loops->int16) {
        c->int16 = best_rate(&j, pool);
        printf("  %-29s %7.1f G operations/s\n", "multiply-add, 16-bit integers", 1e-9 * c->int16);
    }
    j.kind = READ;
    j.from = memory;
    for (size_t i = 0; i < ADCGS_COUNTOF(read_bytes); i++) {
        j.n = (i < 2 ? read_bytes[i] : read_bytes[i] / (size_t)threads) / sizeof(float) / 1024 * 1024;
        j.times = (int)(READ_LEAST / (j.n * sizeof(float)) + 1);
        c->read[i] = best_rate(&j, pool);
        printf("  %-29s %7.1f GB/s\n", read_names[i], 1e-9 * c->read[i]);
    }
}

void bench_find_ceilings(bench *b)
{
    float *memory = bench_floats(read_bytes[3] / sizeof(float));
    adcgs_error error = {.status = ADCGS_OK};
    memset(memory, 1, read_bytes[3]); /* all pages that were never written are the same physical page */
    for (int i = 0; i < 2; i++) {
        adcgs_pool *pool = NULL;
        bench_check(adcgs_pool_create(&pool, i ? b->threads : 1, &error), &error);
        printf("ceilings, %s, %d thread%s\n", adcgs_cpu_name(b->level), adcgs_pool_threads(pool), i ? "s" : "");
        find(b, pool, &b->ceilings[i], memory);
        adcgs_pool_free(&pool);
    }
    adcgs_free(NULL, memory);
}
