/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The test views of one run: their quality over time as a chart, the worst and the middle one as images. */
#include "config.h"

#include "apps/sweep/charts.h"
#include "apps/sweep/run.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- Chart ---- */

/** Prints a block of time and quality, of moving regions or whole views. Returns the number of views with that value. */
static int print_block(FILE *script, const adcgs_sweep_shown *shown, int moving)
{
    int n = 0;
    for (int i = 0; i < shown->n_views; i++) {
        const adcgs_sweep_view *const view = &shown->view[i];
        const double value = moving ? view->moving : view->psnr;
        if (!isfinite(view->time) || !isfinite(value))
            continue;
        if (!n++)
            fprintf(script, "%s << END\n", moving ? "$moving" : "$all");
        fprintf(script, "%.9g %.9g\n", view->time, value);
    }
    if (n)
        fprintf(script, "END\n");
    return n;
}

adcgs_status adcgs_chart_views(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *drawn,
                               adcgs_error *error)
{
    const adcgs_sweep_shown *const shown = &plan->shown;
    adcgs_atomic file;
    *drawn = 0;
    ADCGS_TRY(adcgs_chart_open(&file, sweep, chart->name, error));
    const int n = print_block(file.file, shown, 0), moving = print_block(file.file, shown, 1);
    if (n < 2) {
        adcgs_atomic_abort(&file);
        return ADCGS_OK;
    }
    fprintf(file.file,
            "set title '%s: test views of %s'\nset xlabel 'time, s'\nset ylabel 'PSNR, dB'\n"
            "set offsets 0, 0, graph 0.05, graph 0.05\nplot $all using 1:2 smooth unique with lines linewidth 1.5 "
            "linecolor rgb '#0060ad' title 'mean at a time', $all using 1:2 with points pointtype 7 pointsize 0.4 "
            "linecolor rgb '#0060ad' title 'view'",
            chart->title, shown->run->tag);
    if (moving)
        fprintf(file.file, ", \\\n  $moving using 1:2 smooth unique with lines linewidth 1.5 linecolor rgb '#c03000' title "
                           "'of moving regions', $moving using 1:2 with points pointtype 7 pointsize 0.4 linecolor rgb '#c03000' "
                           "notitle");
    fprintf(file.file, "\n");
    ADCGS_TRY(adcgs_atomic_commit(&file, error));
    return adcgs_chart_draw(sweep, chart->name, drawn, error);
}

/* ---- Images ---- */

typedef struct ranked {
    double psnr;
    unsigned index;
} ranked;

static int by_psnr(const void *a, const void *b)
{
    const ranked *const x = a, *const y = b;
    return x->psnr != y->psnr ? (x->psnr > y->psnr) - (x->psnr < y->psnr) : (x->index > y->index) - (x->index < y->index);
}

/** Picks the worst and the middle view; returns 0 if there are none. */
static int pick(const adcgs_sweep_shown *shown, adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES])
{
    ranked *const list = calloc((size_t)shown->n_views + 1, sizeof *list);
    size_t known = 0;
    for (int i = 0; list && i < shown->n_views; i++)
        if (isfinite(shown->view[i].psnr))
            list[known++] = (ranked){shown->view[i].psnr, (unsigned)i};
    if (known) {
        qsort(list, known, sizeof *list, by_psnr);
        const ranked *const chosen[ADCGS_SWEEP_PICTURES] = {&list[0], &list[known / 2]};
        for (int i = 0; i < ADCGS_SWEEP_PICTURES; i++) {
            picture[i].psnr = chosen[i]->psnr;
            picture[i].index = chosen[i]->index;
            picture[i].time = shown->view[chosen[i]->index].time;
        }
    }
    free(list);
    return known > 0;
}

/** Keeps the picked images of the folder, under their own names, and removes the folder. */
static void keep_picked(const char *folder, adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES])
{
    DIR *const files = opendir(folder);
    for (const struct dirent *file; files && (file = readdir(files));) {
        char path[ADCGS_SWEEP_PATH + 256];
        char *end;
        const unsigned long index = strtoul(file->d_name, &end, 10);
        if (end == file->d_name || *end != '-')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, file->d_name);
        for (int i = 0; i < ADCGS_SWEEP_PICTURES; i++)
            if (index == picture[i].index) /* both, if there is a single view; some file systems have no links */
                picture[i].is_there = link(path, picture[i].path) == 0 || rename(path, picture[i].path) == 0;
        unlink(path);
    }
    if (files)
        closedir(files);
    rmdir(folder);
}

adcgs_status adcgs_sweep_pictures(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                  adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES], adcgs_error *error)
{
    static const char *const names[ADCGS_SWEEP_PICTURES] = {"worst", "middle"};
    const adcgs_sweep_run *const run = plan->shown.run;
    char folder[ADCGS_SWEEP_PATH];
    memset(picture, 0, ADCGS_SWEEP_PICTURES * sizeof *picture);
    if (!run || !pick(&plan->shown, picture))
        return ADCGS_OK;
    for (int i = 0; i < ADCGS_SWEEP_PICTURES; i++) {
        picture[i].name = names[i];
        picture[i].run = run->tag;
        snprintf(picture[i].path, sizeof picture[i].path, "%s/%s.png", sweep->directory, names[i]);
        unlink(picture[i].path);
    }
    snprintf(folder, sizeof folder, "%s/views.part", sweep->directory);
    const adcgs_status status = adcgs_sweep_draw_views(sweep, run, folder, error);
    keep_picked(folder, picture);
    return status;
}
