/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The chart of one run's quality when a part of the stream has been read: layers, tiers, bytes. */
#include "config.h"

#include "apps/sweep/charts.h"

#include <math.h>

static const struct {
    const char *title, *colour;
    int point, open;    /**< gnuplot's point types: of whole views, of moving regions */
    const char *labels; /**< offset of labels with the count, next to the points; NULL: the axis shows it */
} kinds[ADCGS_PORTION_COUNT] = {
    [ADCGS_PORTION_LAYERS] = {"first layers", "#0060ad", 5, 4, "offset 0.9,-0.7"},
    [ADCGS_PORTION_TIERS] = {"first tiers", "#008f5a", 9, 8, "offset -0.7,0.8"},
    [ADCGS_PORTION_PERCENT] = {"first bytes of the file", "#c03000", 7, 6, NULL},
};

static const char *const all_or_moving[] = {"all", "moving"};

/**
 * Prints a block of kB, PSNR and count, for moving regions or whole views. Returns the number of points; a single point is no
 * curve, and is left out.
 */
static int print_block(FILE *script, const adcgs_sweep_shown *shown, int kind, int moving)
{
    int n = 0;
    for (int pass = 0; pass < 2; pass++) {
        if (pass && n < 2)
            return 0;
        if (pass)
            fprintf(script, "$%s_%s << END\n", adcgs_portion_name(kind), all_or_moving[moving]);
        for (int i = 0; i < shown->n_portions; i++) {
            const adcgs_sweep_portion *const p = &shown->portion[i];
            const double quality = moving ? p->moving : p->psnr;
            if ((int)p->kind != kind || !isfinite(quality))
                continue;
            n += !pass;
            if (pass)
                fprintf(script, "%.9g %.9g %d\n", p->bytes / 1000, quality, p->count);
        }
    }
    fprintf(script, "END\n");
    return n;
}

static void print_curve(FILE *script, int kind, int moving)
{
    const char *const name = adcgs_portion_name(kind), *const what = all_or_moving[moving];
    fprintf(script,
            "$%s_%s using 1:2 with linespoints linecolor rgb '%s' linewidth %s dashtype %d pointtype %d pointsize 0.8 "
            "title '%s%s'",
            name, what, kinds[kind].colour, moving ? "1.3" : "2.2", moving ? 2 : 1, moving ? kinds[kind].open : kinds[kind].point,
            kinds[kind].title, moving ? ", moving regions" : "");
    if (kinds[kind].labels)
        fprintf(script, ", \\\n  $%s_%s using 1:2:3 with labels %s font ',9' textcolor rgb '%s' notitle", name, what,
                kinds[kind].labels, kinds[kind].colour);
}

/** Bytes below, their share of the file above. */
static void print_axes(FILE *script, const char *title, const adcgs_sweep_shown *shown)
{
    fprintf(script,
            "set title '%s: test views of %s; labels count layers and tiers'\n"
            "set xlabel 'read of the file, kB (1000 bytes)'\nset ylabel 'PSNR, dB'\n"
            "set xrange [0:%.9g]\nset x2range [0:103]\nset x2tics 10 format '%%g %%%%'\nset xtics nomirror\n"
            "set offsets 0, 0, graph 0.05, graph 0.05\nset key maxcols 3\n",
            title, shown->run->tag, 1.03 * shown->run->figure[ADCGS_FIGURE_BYTES] / 1000);
}

adcgs_status adcgs_chart_portions(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *drawn,
                                  adcgs_error *error)
{
    const char *separator = "plot ";
    int points[2][ADCGS_PORTION_COUNT], any = 0;
    adcgs_atomic file;
    *drawn = 0;
    ADCGS_TRY(adcgs_chart_open(&file, sweep, chart->name, error));
    for (int moving = 0; moving < 2; moving++)
        for (int kind = 0; kind < ADCGS_PORTION_COUNT; kind++)
            any |= points[moving][kind] = print_block(file.file, &plan->shown, kind, moving);
    if (!any) {
        adcgs_atomic_abort(&file);
        return ADCGS_OK;
    }
    print_axes(file.file, chart->title, &plan->shown);
    for (int moving = 0; moving < 2; moving++)
        for (int kind = 0; kind < ADCGS_PORTION_COUNT; kind++)
            if (points[moving][kind]) {
                fprintf(file.file, "%s", separator);
                print_curve(file.file, kind, moving);
                separator = ", \\\n  ";
            }
    fprintf(file.file, "\n");
    ADCGS_TRY(adcgs_atomic_commit(&file, error));
    return adcgs_chart_draw(sweep, chart->name, drawn, error);
}
