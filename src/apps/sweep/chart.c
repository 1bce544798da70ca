/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The charts of a sweep that are curves: one quantity of its points against another, for all curves and yardsticks. */
#include "config.h"

#include "apps/sweep/charts.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/** Ratio of the largest to the smallest value from which an axis is logarithmic; chosen by hand, not measured. */
#define DECADE 10.0

/** A quantity of points, in the unit of an axis. */
typedef struct quantity {
    const char *label;
    size_t at; /**< offset of its adcgs_spread in adcgs_sweep_row */
    double unit;
    int is_gain;   /**< more is better */
    int of_stream; /**< only streams have it */
} quantity;

#define OF(field) offsetof(adcgs_sweep_row, field)
static const quantity quantities[ADCGS_Q_COUNT] = {
    [ADCGS_Q_BYTES] = {"bytes on disk, kB (1000 bytes)", OF(bytes), 1000, 0, 0},
    [ADCGS_Q_SECONDS] = {"CPU seconds of training", OF(seconds), 1, 0, 1},
    [ADCGS_Q_SPEED] = {"frames per second", OF(speed), 1, 1, 1},
    [ADCGS_Q_PSNR] = {"PSNR, dB", OF(psnr), 1, 1, 0},
    [ADCGS_Q_MOVING] = {"PSNR of moving regions, dB", OF(moving), 1, 1, 0},
    [ADCGS_Q_SSIM] = {"SSIM", OF(ssim), 1, 1, 0},
};

/** A point of a chart. */
typedef struct point {
    adcgs_spread x, y; /**< in the units of the axes */
    double lambda;
    int curve;
} point;

/** All points of a chart. */
typedef struct cloud {
    const quantity *x, *y;
    point *point;
    int n, spreads;                   /**< some points are means over several seeds */
    double least, most;               /**< of x */
    int of_curve[ADCGS_SWEEP_CURVES]; /**< points per curve */
} cloud;

static adcgs_spread value_of(const adcgs_sweep_row *row, const quantity *q)
{
    adcgs_spread s;
    memcpy(&s, (const char *)row + q->at, sizeof s);
    s.mean /= q->unit;
    s.min /= q->unit;
    s.max /= q->unit;
    return q->of_stream && !row->is_stream ? adcgs_spread_one((double)NAN) : s;
}

static void add_point(cloud *c, const adcgs_sweep_row *row, int curve)
{
    const point p = {value_of(row, c->x), value_of(row, c->y), row->lambda, curve};
    if (!isfinite(p.x.mean) || !isfinite(p.y.mean))
        return;
    c->least = c->n ? fmin(c->least, p.x.min) : p.x.min;
    c->most = c->n ? fmax(c->most, p.x.max) : p.x.max;
    c->spreads |= p.x.n > 1 || p.y.n > 1;
    c->of_curve[curve]++;
    c->point[c->n++] = p;
}

static adcgs_status gather(cloud *c, const adcgs_sweep_plan *plan, adcgs_error *error)
{
    c->point = calloc((size_t)ADCGS_SWEEP_CURVES * ADCGS_SWEEP_LIST, sizeof *c->point);
    if (!c->point)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a chart");
    for (int i = 0; i < plan->n_curves; i++)
        for (int j = 0; j < plan->curve[i].n; j++) {
            adcgs_sweep_row row;
            if (adcgs_sweep_point(&row, plan, &plan->curve[i], j))
                add_point(c, &row, i);
        }
    return ADCGS_OK;
}

/* ---- Fronts ---- */

static int by_x(const void *a, const void *b)
{
    const double x = ((const point *)a)->x.mean, y = ((const point *)b)->x.mean;
    return (x > y) - (x < y);
}

/**
 * Prints the points that no other point exceeds in both quantities, as the block $front. Yardsticks do not count, since they
 * measure something else. Returns the number of points.
 */
static int print_front(FILE *script, const adcgs_sweep_plan *plan, const cloud *c)
{
    point sorted[ADCGS_SWEEP_CURVES * ADCGS_SWEEP_LIST];
    double best = -INFINITY;
    int n = 0, front = 0;
    for (int i = 0; i < c->n; i++)
        if (!plan->curve[c->point[i].curve].yardstick)
            sorted[n++] = c->point[i];
    qsort(sorted, (size_t)n, sizeof *sorted, by_x);
    for (int i = 0; i < n; i++) {
        const point *const p = &sorted[c->x->is_gain ? n - 1 - i : i];
        if (p->y.mean <= best)
            continue;
        best = p->y.mean;
        if (!front++)
            fprintf(script, "$front << END\n");
        fprintf(script, "%.9g %.9g\n", p->x.mean, best);
    }
    if (front)
        fprintf(script, "END\n");
    return front;
}

/* ---- Curves ---- */

/** Prints a block of data for each curve that has points. */
static void print_block(FILE *script, const cloud *c, int curve)
{
    fprintf(script, "$curve%d << END\n", curve);
    for (int i = 0; i < c->n; i++) {
        const point *const p = &c->point[i];
        if (p->curve == curve)
            fprintf(script, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p->x.mean, p->x.min, p->x.max, p->y.mean, p->y.min, p->y.max,
                    p->lambda);
    }
    fprintf(script, "END\n");
}

/** Prints the style of a curve: the codec's own curves are thick with dots, the yardsticks have shapes of their own. */
static void print_plot(FILE *script, const adcgs_sweep_plan *plan, int index, int points, int spreads)
{
    static const char *const colours[] = {"#0060ad", "#008f5a", "#7a3db8", "#b03060", "#5a5a5a",
                                          "#d98000", "#c03000", "#806000", "#207080", "#a040a0"};
    static const int shapes[] = {5, 9, 11, 13, 4, 8, 10, 12};
    const adcgs_sweep_curve *const curve = &plan->curve[index];
    const char *const bars = points > 1 ? "xyerrorlines" : "xyerrorbars", *const plain = points > 1 ? "linespoints" : "points";
    fprintf(script, "$curve%d using %s with %s linecolor rgb '%s' pointtype %d pointsize %s", index,
            spreads ? "1:4:2:3:5:6" : "1:4", spreads ? bars : plain, colours[(size_t)index % ADCGS_COUNTOF(colours)],
            curve->yardstick ? shapes[(size_t)index % ADCGS_COUNTOF(shapes)] : 7,
            points == 1        ? "1.2"
            : curve->yardstick ? "0.9"
                               : "0.7");
    if (points > 1 || spreads)
        fprintf(script, " linewidth %s", curve->yardstick ? "1.2" : "2.2");
    fprintf(script, " title '%s'", curve->name);
    if (!curve->yardstick)
        fprintf(script,
                ", \\\n  $curve%d using 1:4:($7 < 0 ? '' : sprintf('%%g', $7)) with labels offset 0,0.9 font ',9' "
                "notitle",
                index);
}

static void print_curves(FILE *script, const adcgs_sweep_plan *plan, const cloud *c)
{
    const char *separator = "plot ";
    int shown = 0;
    for (int i = 0; i < plan->n_curves; i++)
        if (c->of_curve[i]) {
            print_block(script, c, i);
            shown += !plan->curve[i].yardstick;
        }
    if (print_front(script, plan, c) > 1 && shown > 1) {
        fprintf(script, "plot $front using 1:2 with lines linecolor rgb '#bbbbbb' linewidth 7 title 'best of all'");
        separator = ", \\\n  ";
    }
    for (int i = 0; i < plan->n_curves; i++)
        if (c->of_curve[i]) {
            fprintf(script, "%s", separator);
            print_plot(script, plan, i, c->of_curve[i], c->spreads);
            separator = ", \\\n  ";
        }
    fprintf(script, "\n");
}

/** Prints ticks at 1, 2 and 5 of every decade. */
static void print_log_axis(FILE *script, const cloud *c)
{
    const char *separator = "";
    fprintf(script, "set logscale x\nset xtics (");
    for (double decade = pow(10, floor(log10(c->least))); decade <= c->most; decade *= 10)
        for (int i = 0; i < 3; i++) {
            fprintf(script, "%s%g", separator, decade * (i == 0 ? 1 : i == 1 ? 2 : 5));
            separator = ", ";
        }
    fprintf(script, ")\n");
}

static void print_chart(FILE *script, const char *title, const adcgs_sweep_plan *plan, const cloud *c)
{
    const int is_log = c->least > 0 && c->most >= DECADE * c->least;
    fprintf(script,
            "set title '%s: decoded files on the test views; labels are lambda%s'\n"
            "set xlabel '%s%s'\nset ylabel '%s'\nset offsets graph 0.05, graph 0.05, graph 0.08, graph 0.05\n",
            title, c->spreads ? ", bars the spread over seeds" : "", c->x->label, is_log ? ", logarithmic" : "", c->y->label);
    if (is_log)
        print_log_axis(script, c);
    print_curves(script, plan, c);
}

adcgs_status adcgs_chart_curves(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *drawn,
                                adcgs_error *error)
{
    cloud c = {.x = &quantities[chart->x], .y = &quantities[chart->y]};
    adcgs_atomic file;
    *drawn = 0;
    adcgs_status status = gather(&c, plan, error);
    if (status == ADCGS_OK && c.n) {
        status = adcgs_chart_open(&file, sweep, chart->name, error);
        if (status == ADCGS_OK) {
            print_chart(file.file, chart->title, plan, &c);
            status = adcgs_atomic_commit(&file, error);
        }
        if (status == ADCGS_OK)
            status = adcgs_chart_draw(sweep, chart->name, drawn, error);
    }
    free(c.point);
    return status;
}
