/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Measurement. */
#define _POSIX_C_SOURCE 200809L

#include "ceilings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ITEMS_MAX = 8, ROUNDS_MAX = 101 };

void bench_check(adcgs_status status, const adcgs_error *error)
{
    if (status == ADCGS_OK)
        return;
    fprintf(stderr, "adcgs-bench: %s\n", error && error->text[0] ? error->text : adcgs_status_name(status));
    exit(1);
}

float *bench_floats(size_t n)
{
    adcgs_error error = {.status = ADCGS_OK};
    float *p = adcgs_alloc(NULL, n, sizeof *p, &error);
    bench_check(p ? ADCGS_OK : ADCGS_ERR_MEMORY, &error);
    return p;
}

int bench_wants(const bench *b, const char *beginning)
{
    return !b->only || !strncmp(beginning, b->only, ADCGS_MIN(strlen(beginning), strlen(b->only)));
}

/* ---- Turns ---- */

/** Processor time of one thread; elapsed time of several. */
static double clock_of(int threads)
{
    struct timespec now;
    if (threads > 1 || clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now) != 0)
        return adcgs_seconds();
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double seconds_of(const bench_item *item, int times, int threads)
{
    const double start = clock_of(threads);
    for (int i = 0; i < times; i++)
        item->run(item->arg);
    return (clock_of(threads) - start) / times;
}

/** Number of runs of an item in a turn. The runs that determine it also warm up the item. */
static int times_of(const bench *b, const bench_item *item, int threads)
{
    int times = 1;
    for (double took = seconds_of(item, 1, threads); took * times < b->turn && times < 1 << 24;
         took = seconds_of(item, times, threads))
        times = took > 0 ? (int)ADCGS_MIN(1.2 * b->turn / took + 1, 1 << 24) : 2 * times;
    return times;
}

/** Measures the current ceiling of one thread, a second. */
static double ceiling_now(const bench *b, int integers)
{
    const bench_loops *const loops = bench_loops_of(b->level);
    double operations;
    volatile double sum;
    const double start = clock_of(1);
    sum = integers ? loops->int16(1 << 19, &operations) : loops->fma(1 << 19, &operations);
    (void)sum;
    return operations / (clock_of(1) - start);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** The value below which the given share of v[n] lies. */
static double percentile(const double *v, int n, double share)
{
    double sorted[ROUNDS_MAX];
    memcpy(sorted, v, (size_t)n * sizeof *v);
    qsort(sorted, (size_t)n, sizeof *sorted, ascending);
    return sorted[(int)(share * (n - 1) + 0.5)];
}

/* ---- Reports ---- */

static void print_rate(double rate, const char *unit)
{
    static const char *const prefixes[] = {"", "k", "M", "G", "T"};
    size_t i = 0;
    for (; rate >= 1000 && i + 1 < ADCGS_COUNTOF(prefixes); i++)
        rate /= 1000;
    char name[32];
    snprintf(name, sizeof name, "%s%s/s", prefixes[i], unit);
    printf(" %7.2f %-11s", rate, name);
}

void bench_header(const bench *b)
{
    printf("%-31s %9s %19s %19s %8s %7s\n", "median of turns", "ms", "10 % .. 90 %", "rate", "of most", "ratio");
    if (b->csv)
        fprintf(b->csv, "group,item,level,width,height,anchors,splats,threads,ms,ms_10,ms_90,rate,unit,of_most,ratio\n");
}

static void print_place(const bench_place *p)
{
    printf("%s", p->group);
    if (p->width)
        printf(", %dx%d", p->width, p->height);
    if (p->anchors)
        printf(", %u anchors", p->anchors);
    if (p->splats)
        printf(", %u splats", p->splats);
    printf(p->threads > 1 ? ", %d threads\n" : ", %d thread\n", p->threads);
}

static void report(const bench *b, const bench_place *p, const bench_item *item, const double *seconds, const double *first,
                   const double *most)
{
    double ratios[ROUNDS_MAX], shares[ROUNDS_MAX];
    for (int r = 0; r < b->rounds; r++) {
        ratios[r] = first ? seconds[r] / first[r] : 0;
        shares[r] = most ? item->work * fabs(item->cost) / seconds[r] / most[r] : 0;
    }
    const double middle = percentile(seconds, b->rounds, 0.5), ratio = percentile(ratios, b->rounds, 0.5);
    const double low = 1e3 * percentile(seconds, b->rounds, 0.1), high = 1e3 * percentile(seconds, b->rounds, 0.9);
    const double rate = item->work / middle, share = percentile(shares, b->rounds, 0.5);
    printf("  %-29s %9.4f %8.4f .. %7.4f", item->name, 1e3 * middle, low, high);
    print_rate(rate, item->unit);
    if (share > 0)
        printf(" %6.1f %%", 100 * share);
    else
        printf(" %8s", "");
    if (first && seconds != first)
        printf(" %7.2f", ratio);
    printf("\n");
    fflush(stdout);
    if (!b->csv)
        return;
    fprintf(b->csv, "%s,%s,%s,%d,%d,%u,%u,%d,%.6g,%.6g,%.6g,%.6g,%s,%.4g,%.4g\n", p->group, item->name, adcgs_cpu_name(b->level),
            p->width, p->height, p->anchors, p->splats, p->threads, 1e3 * middle, low, high, rate, item->unit, share, ratio);
}

void bench_group(const bench *b, const bench_place *place, const bench_item *items, int n, int compare)
{
    static double seconds[ITEMS_MAX][ROUNDS_MAX], most[2][ROUNDS_MAX];
    const bench_ceilings *const all = &b->ceilings[1];
    int times[ITEMS_MAX], bound[2] = {0, 0};
    if (b->only && strncmp(place->group, b->only, strlen(b->only)) != 0)
        return;
    for (int i = 0; i < n; i++) {
        times[i] = times_of(b, &items[i], place->threads);
        bound[items[i].cost < 0] |= items[i].cost < 0 ? all->int16 > 0 : items[i].cost > 0;
    }
    for (int r = 0; r < b->rounds; r++) {
        for (int k = 0; k < 2; k++)
            if (bound[k])
                most[k][r] = place->threads > 1 ? k ? all->int16 : all->fma : ceiling_now(b, k);
        for (int i = 0; i < n; i++)
            seconds[i][r] = seconds_of(&items[i], times[i], place->threads);
    }
    print_place(place);
    for (int i = 0; i < n; i++) {
        const int kind = items[i].cost < 0;
        report(b, place, &items[i], seconds[i], compare ? seconds[0] : NULL, bound[kind] ? most[kind] : NULL);
    }
}
