/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The chart of the distribution of each stream's bytes: a bar for each point of the codec's own curves. */
#include "config.h"

#include "apps/sweep/charts.h"

#include <math.h>

static const struct {
    const char *name, *colour;
    adcgs_figure figure;
} parts[] = {{"networks", "#7a3db8", ADCGS_FIGURE_NETWORKS},
             {"positions", "#d98000", ADCGS_FIGURE_GEOMETRY},
             {"base features", "#0060ad", ADCGS_FIGURE_BASE},
             {"refining features", "#6fb0e0", ADCGS_FIGURE_DETAIL},
             {"other", "#999999", ADCGS_FIGURE_REST}};

/** Prints a block for a curve, a row for each point with known parts: lambda, and kB of each part. Returns the number of rows. */
static int print_block(FILE *script, const adcgs_sweep_plan *plan, int index)
{
    const adcgs_sweep_curve *const curve = &plan->curve[index];
    int n = 0;
    for (int j = 0; j < curve->n && !curve->yardstick && !curve->earlier; j++) {
        adcgs_sweep_row row;
        if (!adcgs_sweep_point(&row, plan, curve, j) || !adcgs_sweep_spread(plan, curve->cell[j], parts[0].figure).n)
            continue;
        if (!n++)
            fprintf(script, "$parts%d << END\n", index);
        fprintf(script, "%g", row.lambda);
        for (size_t p = 0; p < ADCGS_COUNTOF(parts); p++)
            fprintf(script, " %.9g", adcgs_sweep_spread(plan, curve->cell[j], parts[p].figure).mean / 1000);
        fprintf(script, "\n");
    }
    if (n)
        fprintf(script, "END\n");
    return n;
}

/** Prints the bars of a curve, above its name. Only the first curve explains the colours. */
static void print_bars(FILE *script, const adcgs_sweep_plan *plan, int index, int first)
{
    const char *const name = plan->n_curves > 1 ? plan->curve[index].name : "";
    fprintf(script, "%snewhistogram '%s' font ',8' offset 0,-0.6", first ? "plot " : ", \\\n  ", name);
    for (size_t p = 0; p < ADCGS_COUNTOF(parts); p++) {
        fprintf(script, ", $parts%d using %zu%s linecolor rgb '%s' ", index, p + 2, p ? "" : ":xtic(1)", parts[p].colour);
        if (first)
            fprintf(script, "title '%s'", parts[p].name);
        else
            fprintf(script, "notitle");
    }
}

adcgs_status adcgs_chart_bytes(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *drawn,
                               adcgs_error *error)
{
    adcgs_atomic file;
    int has[ADCGS_SWEEP_CURVES], first = 1;
    *drawn = 0;
    ADCGS_TRY(adcgs_chart_open(&file, sweep, chart->name, error));
    for (int i = 0; i < plan->n_curves; i++)
        has[i] = print_block(file.file, plan, i);
    fprintf(file.file,
            "set title '%s, by lambda'\nset ylabel 'bytes on disk, kB (1000 bytes)'\n"
            "set style data histograms\nset style histogram rowstacked title offset 0,-0.6\n"
            "set style fill solid noborder\nset boxwidth 0.7\nset yrange [0:*]\nset key invert\nset bmargin 9\n",
            chart->title);
    for (int i = 0; i < plan->n_curves; i++)
        if (has[i]) {
            print_bars(file.file, plan, i, first);
            first = 0;
        }
    fprintf(file.file, "\n");
    if (first) {
        adcgs_atomic_abort(&file);
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_atomic_commit(&file, error));
    return adcgs_chart_draw(sweep, chart->name, drawn, error);
}
