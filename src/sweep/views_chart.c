/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Of one run, the test views: their quality over time as a chart, the worst and the middle one as pictures. */
#include "config.h"

#include "sweep/charts.h"

#include "data/camera_json.h"

#include <dirent.h>
#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/** The run that stands for all: the first seed of the middle lambda of the first curve. NULL if it has no result. */
static const adcgs_sweep_run *shown_run(const adcgs_sweep_plan *plan)
{
    const adcgs_sweep_curve *const curve = &plan->curve[0];
    if (!plan->n_curves || curve->earlier || !curve->n)
        return NULL;
    const adcgs_sweep_run *const run = &plan->run[plan->cell[curve->cell[curve->n / 2]].run[0]];
    return run->state == ADCGS_RUN_DONE ? run : NULL;
}

/** The views of a run's result; json_decref() the root. */
static adcgs_status load_views(const adcgs_sweep *sweep, const adcgs_sweep_run *run, json_t **root, const json_t **views,
                               adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_sweep_path(path, sweep, run, ".json");
    ADCGS_TRY(adcgs_json_load(root, path, error));
    *views = json_object_get(json_object_get(*root, "evaluation"), "views");
    return ADCGS_OK;
}

/* ---- Chart ---- */

/** A block of time and quality. Returns how many views have that. */
static int print_block(FILE *script, const json_t *views, const char *block, const char *quality)
{
    int n = 0;
    for (size_t i = 0; i < json_array_size(views); i++) {
        const json_t *const view = json_array_get(views, i);
        const double time = adcgs_sweep_number(view, "time"), value = adcgs_sweep_number(view, quality);
        if (!isfinite(time) || !isfinite(value))
            continue;
        if (!n++)
            fprintf(script, "%s << END\n", block);
        fprintf(script, "%.9g %.9g\n", time, value);
    }
    if (n)
        fprintf(script, "END\n");
    return n;
}

static adcgs_status draw(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_run *run, const json_t *views,
                         int *drawn, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(adcgs_chart_open(&file, sweep, chart->name, error));
    const int n = print_block(file.file, views, "$all", "psnr");
    const int moving = print_block(file.file, views, "$moving", "dynamic_psnr");
    if (n < 2) {
        adcgs_atomic_abort(&file);
        return ADCGS_OK;
    }
    fprintf(file.file, "set title '%s: test views of %s'\nset xlabel 'time, s'\nset ylabel 'PSNR, dB'\n"
                       "set offsets 0, 0, graph 0.05, graph 0.05\nplot $all using 1:2 smooth unique with lines linewidth 1.5 "
                       "linecolor rgb '#0060ad' title 'mean of a moment', $all using 1:2 with points pointtype 7 pointsize 0.4 "
                       "linecolor rgb '#0060ad' title 'view'", chart->title, run->tag);
    if (moving)
        fprintf(file.file, ", \\\n  $moving using 1:2 smooth unique with lines linewidth 1.5 linecolor rgb '#c03000' title "
                           "'of what moves', $moving using 1:2 with points pointtype 7 pointsize 0.4 linecolor rgb '#c03000' "
                           "notitle");
    fprintf(file.file, "\n");
    ADCGS_TRY(adcgs_atomic_commit(&file, error));
    return adcgs_chart_draw(sweep, chart->name, drawn, error);
}

adcgs_status adcgs_chart_views(const adcgs_chart *chart, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, int *drawn,
                               adcgs_error *error)
{
    const adcgs_sweep_run *const run = shown_run(plan);
    const json_t *views;
    json_t *root;
    *drawn = 0;
    if (!run)
        return ADCGS_OK;
    ADCGS_TRY(load_views(sweep, run, &root, &views, error));
    const adcgs_status status = draw(chart, sweep, run, views, drawn, error);
    json_decref(root);
    return status;
}

/* ---- Pictures ---- */

typedef struct ranked {
    double psnr;
    unsigned index;
} ranked;

static int by_psnr(const void *a, const void *b)
{
    const ranked *const x = a, *const y = b;
    return x->psnr != y->psnr ? (x->psnr > y->psnr) - (x->psnr < y->psnr) : (x->index > y->index) - (x->index < y->index);
}

/** Which views are the worst and the middle one; 0 if there are none. */
static int pick(const json_t *views, adcgs_sweep_picture picture[ADCGS_SWEEP_PICTURES])
{
    const size_t n = json_array_size(views);
    ranked *const list = calloc(n + 1, sizeof *list);
    size_t known = 0;
    for (size_t i = 0; list && i < n; i++) {
        const double psnr = adcgs_sweep_number(json_array_get(views, i), "psnr");
        if (isfinite(psnr))
            list[known++] = (ranked){psnr, (unsigned)i};
    }
    if (known) {
        qsort(list, known, sizeof *list, by_psnr);
        const ranked *const chosen[ADCGS_SWEEP_PICTURES] = {&list[0], &list[known / 2]};
        for (int i = 0; i < ADCGS_SWEEP_PICTURES; i++) {
            picture[i].psnr = chosen[i]->psnr;
            picture[i].index = chosen[i]->index;
            picture[i].time = adcgs_sweep_number(json_array_get(views, chosen[i]->index), "time");
        }
    }
    free(list);
    return known > 0;
}

/** Keep of the folder's pictures those that are picked, under their own names, and remove it. */
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
            if (index == picture[i].index) /* both, where there is one view; not all file systems have links */
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
    const adcgs_sweep_run *const run = shown_run(plan);
    const json_t *views;
    json_t *root;
    char folder[ADCGS_SWEEP_PATH];
    memset(picture, 0, ADCGS_SWEEP_PICTURES * sizeof *picture);
    if (!run)
        return ADCGS_OK;
    ADCGS_TRY(load_views(sweep, run, &root, &views, error));
    const int found = pick(views, picture);
    json_decref(root);
    if (!found)
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
