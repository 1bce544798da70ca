/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The chart of a sweep, drawn by gnuplot: PSNR against bytes, all curves and yardsticks. */
#include "config.h"

#include "sweep/sweep.h"

#include "io/atomic.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#define KB 1000.0
/** The axis of bytes becomes logarithmic when sizes span this. */
#define DECADE 10.0
#define MISSING 127 /* exit code without gnuplot */

typedef struct extent {
    double least, most; /* bytes; NaN: nothing to draw */
    int spreads;        /* some point stands for several seeds */
} extent;

static extent measure(const adcgs_sweep_plan *plan)
{
    extent e = {(double)NAN, (double)NAN, 0};
    for (int i = 0; i < plan->n_curves; i++)
        for (int j = 0; j < plan->curve[i].n; j++) {
            adcgs_sweep_row row;
            if (!adcgs_sweep_point(&row, plan, &plan->curve[i], j))
                continue;
            e.least = fmin(e.least, row.bytes.min);
            e.most = fmax(e.most, row.bytes.max);
            e.spreads |= row.bytes.n > 1;
        }
    return e;
}

/** One block of data for each curve that has points. Returns how many it has. */
static int print_block(FILE *script, const adcgs_sweep_plan *plan, int index)
{
    const adcgs_sweep_curve *const curve = &plan->curve[index];
    int n = 0;
    for (int j = 0; j < curve->n; j++) {
        adcgs_sweep_row row;
        if (!adcgs_sweep_point(&row, plan, curve, j))
            continue;
        if (!n++)
            fprintf(script, "$curve%d << END\n", index);
        fprintf(script, "%.3f %.3f %.3f %.4f %.4f %.4f %.9g\n", row.bytes.mean / KB, row.bytes.min / KB, row.bytes.max / KB,
                row.psnr.mean, row.psnr.min, row.psnr.max, row.lambda);
    }
    if (n)
        fprintf(script, "END\n");
    return n;
}

/** How a curve looks: the codec's own are thick with dots, the yardsticks have shapes of their own. */
static void print_plot(FILE *script, const adcgs_sweep_plan *plan, int index, int points, int spreads)
{
    static const char *const colours[] = {"#0060ad", "#008f5a", "#7a3db8", "#b03060", "#5a5a5a", "#d98000", "#c03000", "#806000",
                                          "#207080", "#a040a0"};
    static const int shapes[] = {5, 9, 11, 13, 4, 8, 10, 12};
    const adcgs_sweep_curve *const curve = &plan->curve[index];
    const char *const bars = points > 1 ? "xyerrorlines" : "xyerrorbars", *const plain = points > 1 ? "linespoints" : "points";
    fprintf(script, "$curve%d using %s with %s linecolor rgb '%s' pointtype %d pointsize %s", index,
            spreads ? "1:4:2:3:5:6" : "1:4", spreads ? bars : plain, colours[(size_t)index % ADCGS_COUNTOF(colours)],
            curve->yardstick ? shapes[(size_t)index % ADCGS_COUNTOF(shapes)] : 7,
            points == 1 ? "1.2" : curve->yardstick ? "0.9" : "0.7");
    if (points > 1 || spreads)
        fprintf(script, " linewidth %s", curve->yardstick ? "1.2" : "2.2");
    fprintf(script, " title '%s'", curve->name);
    if (!curve->yardstick)
        fprintf(script, ", \\\n  $curve%d using 1:4:(sprintf('%%g', $7)) with labels offset 0,0.9 font ',9' notitle", index);
}

static void print_curves(FILE *script, const adcgs_sweep_plan *plan, int spreads)
{
    int points[ADCGS_SWEEP_CURVES];
    const char *separator = "plot ";
    for (int i = 0; i < plan->n_curves; i++)
        points[i] = print_block(script, plan, i);
    for (int i = 0; i < plan->n_curves; i++)
        if (points[i]) {
            fprintf(script, "%s", separator);
            print_plot(script, plan, i, points[i], spreads);
            separator = ", \\\n  ";
        }
    fprintf(script, "\n");
}

/** 1, 2 and 5 of every decade. */
static void print_log_axis(FILE *script, const extent *e)
{
    const char *separator = "";
    fprintf(script, "set logscale x\nset xtics (");
    for (double decade = pow(10, floor(log10(e->least / KB))); decade <= e->most / KB; decade *= 10)
        for (int i = 0; i < 3; i++) {
            fprintf(script, "%s%g", separator, decade * (i == 0 ? 1 : i == 1 ? 2 : 5));
            separator = ", ";
        }
    fprintf(script, ")\n");
}

static adcgs_status write_script(const char *path, const adcgs_sweep_plan *plan, const extent *e, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    fprintf(file.file,
            "# Drawn from here by: gnuplot sweep.gp >sweep.svg\n"
            "set terminal svg size 860,620 noenhanced font 'sans-serif,12' background 'white'\n"
            "set title 'Decoded files on the test views; labels are lambda%s'\n"
            "set xlabel 'bytes on disk, kB (1000 bytes)%s'\n"
            "set ylabel 'PSNR, dB'\n"
            "set grid\nset key below height 1 spacing 1.15\nset offsets graph 0.05, graph 0.05, graph 0.08, graph 0.05\n",
            e->spreads ? ", bars the spread over seeds" : "", e->most >= DECADE * e->least ? ", logarithmic" : "");
    if (e->most >= DECADE * e->least)
        print_log_axis(file.file, e);
    print_curves(file.file, plan, e->spreads);
    return adcgs_atomic_commit(&file, error);
}

/*
 * gnuplot runs in the folder, so that no path has to be quoted for it. A missing gnuplot is no fault. It does not notice a full
 * disk, but cat does; and a chart is one when it has an end.
 */
adcgs_status adcgs_sweep_draw(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *chart, adcgs_error *error)
{
    char command[] = "cd \"$1\" || exit 1; command -v gnuplot >/dev/null || exit 127; "
                     "gnuplot sweep.gp | cat >sweep.svg.part && grep -q '</svg>' sweep.svg.part && "
                     "mv -f sweep.svg.part sweep.svg || { rm -f sweep.svg.part; exit 1; }";
    char sh[] = "/bin/sh", c[] = "-c";
    char *const argv[] = {sh, c, command, sh, (char *)(uintptr_t)sweep->directory, NULL};
    char path[ADCGS_SWEEP_PATH];
    int code = 0;
    const extent e = measure(plan);
    *chart = 0;
    if (isnan(e.least))
        return ADCGS_OK;
    snprintf(path, sizeof path, "%s/sweep.gp", sweep->directory);
    ADCGS_TRY(write_script(path, plan, &e, error));
    snprintf(path, sizeof path, "%s/sweep.gp.log", sweep->directory);
    unlink(path);
    ADCGS_TRY(adcgs_sweep_spawn(argv, NULL, path, &code, error));
    if (code == 0)
        unlink(path);
    *chart = code == 0;
    if (code == 0 || code == MISSING)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s/sweep.svg: cannot be drawn by gnuplot, see sweep.gp.log", sweep->directory);
}
