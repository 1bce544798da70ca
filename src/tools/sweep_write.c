/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What a sweep leaves behind: a table as CSV and JSON, and a chart drawn by gnuplot. */
#include "config.h"

#include "tools/sweep.h"

#include "io/atomic.h"
#include "tools/cli.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#define PATH_BYTES 4096

static adcgs_status finish(adcgs_atomic *file, adcgs_error *error)
{
    if (!ferror(file->file))
        return adcgs_atomic_commit(file, error);
    adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot write", file->path);
    adcgs_atomic_abort(file);
    return ADCGS_ERR_IO;
}

static void print_cell(FILE *file, double value, int digits)
{
    if (isfinite(value))
        fprintf(file, ",%.*f", digits, value);
    else
        fprintf(file, ",");
}

static adcgs_status write_csv(const char *path, const adcgs_sweep_point *points, int n, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    fprintf(file.file, "lambda,k,bytes,psnr,ssim,training_seconds,frames_per_second\n");
    for (int i = 0; i < n; i++) {
        const adcgs_sweep_point *const p = &points[i];
        if (!p->done)
            continue;
        fprintf(file.file, "%g,%d,%.0f", p->lambda, p->k, p->bytes);
        print_cell(file.file, p->psnr, 4);
        print_cell(file.file, p->ssim, 6);
        print_cell(file.file, p->training_seconds, 2);
        print_cell(file.file, p->frames_per_second, 2);
        fprintf(file.file, "\n");
    }
    return finish(&file, error);
}

static adcgs_status write_json(const char *path, const adcgs_sweep *sweep, const adcgs_sweep_point *points, int n,
                               adcgs_error *error)
{
    adcgs_atomic file;
    adcgs_json json;
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    adcgs_json_init(&json, file.file);
    adcgs_json_open(&json, NULL, '{');
    adcgs_json_string(&json, "scene", sweep->scene);
    adcgs_json_string(&json, "preset", sweep->preset ? sweep->preset : "");
    adcgs_json_int(&json, "iterations", sweep->iterations);
    adcgs_json_open(&json, "points", '[');
    for (int i = 0; i < n; i++) {
        const adcgs_sweep_point *const p = &points[i];
        if (!p->done)
            continue;
        adcgs_json_open(&json, NULL, '{');
        adcgs_json_real(&json, "lambda", p->lambda);
        adcgs_json_int(&json, "k", p->k);
        adcgs_json_int(&json, "bytes", (int64_t)p->bytes);
        adcgs_json_real(&json, "psnr", p->psnr);
        adcgs_json_real(&json, "ssim", p->ssim);
        adcgs_json_real(&json, "training_seconds", p->training_seconds);
        adcgs_json_real(&json, "frames_per_second", p->frames_per_second);
        adcgs_json_close(&json, '}');
    }
    adcgs_json_close(&json, ']');
    adcgs_json_close(&json, '}');
    const adcgs_status status = adcgs_json_finish(&json, error);
    if (status == ADCGS_OK)
        return finish(&file, error);
    adcgs_atomic_abort(&file);
    return status;
}

/* One block of data per k, its points in the order of the list. */
static void print_blocks(FILE *script, const adcgs_sweep_point *points, int n)
{
    for (int first = 0; first < n; first++) {
        if (first > 0 && points[first].k == points[first - 1].k)
            continue;
        fprintf(script, "$curve%d << END\n", first);
        for (int i = first; i < n && points[i].k == points[first].k; i++)
            if (points[i].done)
                fprintf(script, "%.3f %.4f %g\n", points[i].bytes / 1000.0, points[i].psnr, points[i].lambda);
        fprintf(script, "END\n");
    }
    const char *separator = "plot ";
    for (int first = 0; first < n; first++) {
        if (first > 0 && points[first].k == points[first - 1].k)
            continue;
        fprintf(script, "%s$curve%d using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.6 title ", separator, first);
        if (points[first].k)
            fprintf(script, "'K = %d'", points[first].k);
        else
            fprintf(script, "'adcgs'");
        fprintf(script, ", \\\n  $curve%d using 1:2:(sprintf('%%g', $3)) with labels offset 0,1 font ',9' notitle", first);
        separator = ", \\\n  ";
    }
    fprintf(script, "\n");
}

static adcgs_status write_script(const char *path, const char *chart, const adcgs_sweep_point *points, int n, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    fprintf(file.file,
            "# Drawn from here by: gnuplot sweep.gp\n"
            "set terminal svg size 720,480 font 'sans-serif,12' background 'white'\n"
            "set output '%s'\n"
            "set title 'Rate and distortion on the test views; labels are lambda'\n"
            "set xlabel 'file size, kB (1000 bytes)'\n"
            "set ylabel 'PSNR, dB'\n"
            "set grid\nset key bottom right\nset offsets graph 0.05, graph 0.05, graph 0.08, graph 0.05\n",
            chart);
    print_blocks(file.file, points, n);
    return finish(&file, error);
}

static int any_done(const adcgs_sweep_point *points, int n)
{
    for (int i = 0; i < n; i++)
        if (points[i].done)
            return 1;
    return 0;
}

/* gnuplot runs in the folder, so that no path has to be quoted for it. A missing gnuplot is no fault. */
static adcgs_status draw(const adcgs_sweep *sweep, int *chart, adcgs_error *error)
{
    char command[] = "cd \"$1\" && gnuplot sweep.gp && mv -f sweep.svg.part sweep.svg";
    char sh[] = "/bin/sh", c[] = "-c";
    char *const argv[] = {sh, c, command, sh, (char *)(uintptr_t)sweep->directory, NULL};
    char log[PATH_BYTES];
    int code = 0;
    snprintf(log, sizeof log, "%s/sweep.gp.log", sweep->directory);
    unlink(log);
    ADCGS_TRY(adcgs_sweep_spawn(argv, NULL, log, &code, error));
    if (code == 0)
        unlink(log);
    *chart = code == 0;
    return ADCGS_OK;
}

adcgs_status adcgs_sweep_write(const adcgs_sweep *sweep, const adcgs_sweep_point *points, int n, int *chart, adcgs_error *error)
{
    char path[PATH_BYTES];
    *chart = 0;
    snprintf(path, sizeof path, "%s/sweep.csv", sweep->directory);
    ADCGS_TRY(write_csv(path, points, n, error));
    snprintf(path, sizeof path, "%s/sweep.json", sweep->directory);
    ADCGS_TRY(write_json(path, sweep, points, n, error));
    if (!any_done(points, n))
        return ADCGS_OK;
    snprintf(path, sizeof path, "%s/sweep.gp", sweep->directory);
    ADCGS_TRY(write_script(path, "sweep.svg.part", points, n, error));
    return draw(sweep, chart, error);
}
