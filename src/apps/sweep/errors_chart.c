/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The chart of one run's quality by test view: a panel for whole views, and one for their moving regions. If each of several
 * cameras sees several times, it is a map of cameras and times, else a bar for each view, from the mean.
 */
#include "config.h"

#include "apps/sweep/charts.h"

#include <math.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define LABELS_X 26 /* labels that fit below a panel */
#define LABELS_Y 16 /* labels that fit next to it */
#define LABEL 20    /* characters of a label */

static double quality_of(const adcgs_sweep_view *view, int moving)
{
    return moving ? view->moving : view->psnr;
}

static int count_known(const adcgs_sweep_shown *shown, int moving)
{
    int n = 0;
    for (int i = 0; i < shown->n_views; i++)
        n += isfinite(quality_of(&shown->view[i], moving));
    return n;
}

/** True if a view is the first of a camera. */
static int begins(const adcgs_sweep_shown *shown, int index)
{
    return index == 0 || shown->view[index].camera != shown->view[index - 1].camera;
}

static int count_cameras(const adcgs_sweep_shown *shown)
{
    int n = 0;
    for (int i = 0; i < shown->n_views; i++)
        n += begins(shown, i);
    return n;
}

/** True if every view has a time, and there are several cameras with several views each. */
static int is_map(const adcgs_sweep_shown *shown)
{
    for (int i = 0; i < shown->n_views; i++) {
        const int is_single = begins(shown, i) && (i + 1 == shown->n_views || begins(shown, i + 1));
        if (!isfinite(shown->view[i].time) || is_single)
            return 0;
    }
    return count_cameras(shown) > 1;
}

/** Prints the name of a file or camera in gnuplot's quotes, shortened to the available room. */
static void print_label(FILE *script, const char *name, int index, double at)
{
    char text[LABEL + 1], number[LABEL + 1];
    snprintf(number, sizeof number, "%d", index);
    adcgs_sweep_write_name(text, sizeof text, *name ? name : number, strlen(*name ? name : number));
    fprintf(script, "'%s' %g", text, at);
}

/* ---- Bars ---- */

/** Views of a single camera are labelled by their times, views of several by their names. */
static void print_view_tics(FILE *script, const adcgs_sweep_shown *shown)
{
    const int step = (shown->n_views + LABELS_X - 1) / LABELS_X, one = count_cameras(shown) == 1 && isfinite(shown->view[0].time);
    fprintf(script, "set xlabel '%s'\nset xtics rotate by 40 right font ',9' (", one ? "time of the view, s" : "view");
    for (int i = 0; i < shown->n_views; i += step) {
        char time[LABEL + 1];
        snprintf(time, sizeof time, "%.3g", shown->view[i].time);
        fprintf(script, "%s", i ? ", " : "");
        print_label(script, one ? time : shown->view[i].name, i, i);
    }
    fprintf(script, ")\n");
}

/** Prints a block of numbers and qualities. Returns the mean. */
static double print_bars_block(FILE *script, const adcgs_sweep_shown *shown, int moving)
{
    double sum = 0;
    fprintf(script, "$%s << END\n", moving ? "moving" : "all");
    for (int i = 0; i < shown->n_views; i++) {
        const double quality = quality_of(&shown->view[i], moving);
        if (!isfinite(quality))
            continue;
        fprintf(script, "%d %.9g\n", i, quality);
        sum += quality;
    }
    fprintf(script, "END\n");
    return sum / count_known(shown, moving);
}

static void print_bars(FILE *script, const adcgs_sweep_shown *shown, int moving, double mean)
{
    const char *const block = moving ? "moving" : "all", *const colour = moving ? "#c03000" : "#0060ad";
    fprintf(script, "set xrange [-0.7:%g]\nset offsets 0, 0, graph 0.12, graph 0.12\nset ylabel 'PSNR%s, dB'\n",
            shown->n_views - 0.3, moving ? " of moving regions" : "");
    fprintf(script,
            "plot $%s using 1:(%.9g):(0):($2-%.9g) with vectors nohead linewidth 2.5 linecolor rgb '%s' title '%s', \\\n"
            "  $%s using 1:2 with points pointtype 7 pointsize 0.8 linecolor rgb '%s' notitle, \\\n"
            "  %.9g with lines linecolor rgb '#222222' linewidth 1.5 dashtype 2 title 'mean %.2f dB'\n",
            block, mean, mean, colour, moving ? "moving regions of a view" : "a view", block, colour, mean, mean);
}

/* ---- Map ---- */

/** The time halfway to the neighbouring view, or as far beyond the view if there is none. */
static double border(const adcgs_sweep_shown *shown, int index, int step)
{
    const int next = index + step, is_end = step < 0 ? begins(shown, index) : next == shown->n_views || begins(shown, next);
    const double here = shown->view[index].time;
    return is_end ? here + (here - shown->view[index - step].time) / 2 : (here + shown->view[next].time) / 2;
}

/** Prints a block of rectangles: time and row, their bounds, quality. */
static void print_map_block(FILE *script, const adcgs_sweep_shown *shown, int moving)
{
    int row = -1;
    fprintf(script, "$%s << END\n", moving ? "moving" : "all");
    for (int i = 0; i < shown->n_views; i++) {
        const double quality = quality_of(&shown->view[i], moving);
        row += begins(shown, i);
        if (isfinite(quality))
            fprintf(script, "%.9g %d %.9g %.9g %.9g %.9g %.9g\n", shown->view[i].time, row, border(shown, i, -1),
                    border(shown, i, 1), row - 0.5, row + 0.5, quality);
    }
    fprintf(script, "END\n");
}

/** Labels a camera by the name of its first view if the next one has the same name, else by its number. */
static void print_camera_tics(FILE *script, const adcgs_sweep_shown *shown)
{
    const int step = (count_cameras(shown) + LABELS_Y - 1) / LABELS_Y;
    const char *separator = "set ytics font ',9' (";
    int row = -1;
    for (int i = 0; i < shown->n_views; i++) {
        row += begins(shown, i);
        if (!begins(shown, i) || row % step)
            continue;
        const int is_name = !strcmp(shown->view[i].name, shown->view[i + 1].name);
        fprintf(script, "%s", separator);
        print_label(script, is_name ? shown->view[i].name : "", shown->view[i].camera, row);
        separator = ", ";
    }
    fprintf(script, ")\n");
}

static void print_map(FILE *script, const adcgs_sweep_shown *shown, int moving)
{
    fprintf(script, "set yrange [%g:-0.5]\nset ylabel 'camera'\nset cblabel 'PSNR%s, dB' offset 1.5,0\n",
            count_cameras(shown) - 0.5, moving ? " of moving regions" : "");
    fprintf(script, "plot $%s using 1:2:3:4:5:6:7 with boxxyerror fillstyle solid noborder linecolor palette notitle\n",
            moving ? "moving" : "all");
}

/* ---- Both ---- */

/** Prints the data of n panels, and their common settings. Bars begin at the mean, which is returned in mean. */
static void print_data(FILE *script, const adcgs_sweep_shown *shown, int n, double mean[2])
{
    const int map = is_map(shown);
    for (int moving = 0; moving < n; moving++)
        if (map)
            print_map_block(script, shown, moving);
        else
            mean[moving] = print_bars_block(script, shown, moving);
    fprintf(script, "set grid noxtics\n");
    if (!map)
        return;
    fprintf(script, "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n"
                    "set autoscale xfix\nset grid noytics\n");
    print_camera_tics(script, shown);
}

/** Prints the axis below all panels, for the lowest panel only. */
static void print_below(FILE *script, const adcgs_sweep_shown *shown, int is_lowest)
{
    if (!is_lowest)
        fprintf(script, "unset xtics\n");
    else if (is_map(shown))
        fprintf(script, "set xtics autofreq\nset xlabel 'time, s'\n");
    else
        print_view_tics(script, shown);
}

static void print_panels(FILE *script, const adcgs_chart *chart, const adcgs_sweep_shown *shown, int n)
{
    const double top = 0.87, bottom = 0.17, gap = 0.08, height = (top - bottom - gap * (n - 1)) / n;
    double mean[2];
    print_data(script, shown, n, mean);
    fprintf(script, "set multiplot title '%s: test views of %s'\nset lmargin at screen 0.1\nset rmargin at screen %g\n",
            chart->title, shown->run->tag, is_map(shown) ? 0.83 : 0.97);
    for (int i = 0; i < n; i++) {
        const double at = top - i * (height + gap);
        fprintf(script,
                "set tmargin at screen %g\nset bmargin at screen %g\n"
                "set key at screen 0.97, screen %g right horizontal\n",
                at, at - height, at + 0.05);
        print_below(script, shown, i == n - 1);
        if (is_map(shown))
            print_map(script, shown, i);
        else
            print_bars(script, shown, i, mean[i]);
    }
    fprintf(script, "unset multiplot\n");
}

adcgs_status adcgs_chart_errors(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *drawn,
                                adcgs_error *error)
{
    const adcgs_sweep_shown *const shown = &plan->shown;
    adcgs_atomic file;
    *drawn = 0;
    if (count_known(shown, 0) < 2)
        return ADCGS_OK;
    ADCGS_TRY(adcgs_chart_open(&file, sweep, chart->name, error));
    print_panels(file.file, chart, shown, count_known(shown, 1) ? 2 : 1);
    ADCGS_TRY(adcgs_atomic_commit(&file, error));
    return adcgs_chart_draw(sweep, chart->name, drawn, error);
}
