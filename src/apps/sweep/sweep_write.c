/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The output of a sweep for other programs: tables as CSV, everything as JSON. */
#include "config.h"

#include "apps/sweep/sweep.h"

#include "system/atomic.h"
#include "system/json.h"
#include "system/text.h"

#include <math.h>
#include <stdlib.h>

/* ---- CSV ---- */

static void csv_number(FILE *file, double value, int digits)
{
    if (isfinite(value))
        fprintf(file, ",%.*f", digits, value);
    else
        fprintf(file, ",");
}

static void csv_row(FILE *file, const adcgs_sweep_row *r)
{
    adcgs_text_cell(file, r->name);
    fprintf(file, ",");
    if (r->lambda >= 0)
        fprintf(file, "%.9g", r->lambda);
    fprintf(file, ",");
    adcgs_text_cell(file, r->choice);
    fprintf(file, ",%d", r->bytes.n);
    csv_number(file, r->bytes.mean, 0);
    csv_number(file, r->bytes.min, 0);
    csv_number(file, r->bytes.max, 0);
    csv_number(file, r->psnr.mean, 4);
    csv_number(file, r->psnr.min, 4);
    csv_number(file, r->psnr.max, 4);
    csv_number(file, r->ssim.mean, 6);
    csv_number(file, r->networks, 4);
    csv_number(file, r->seconds.mean, 2);
    csv_number(file, r->speed.mean, 2);
    csv_number(file, r->moving.mean, 4);
    csv_number(file, r->objective.mean, 6);
    fprintf(file, "\n");
}

static adcgs_status csv_open(adcgs_atomic *file, const adcgs_sweep *sweep, const char *name, const char *heading,
                             adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    snprintf(path, sizeof path, "%s/%s", sweep->directory, name);
    ADCGS_TRY(adcgs_atomic_open(file, path, error));
    fprintf(file->file, "%s\n", heading);
    return ADCGS_OK;
}

/** Columns of csv_row(), after the name. */
#define ROW_COLUMNS                                                                                        \
    "lambda,choice,seeds,bytes,bytes_min,bytes_max,psnr,psnr_min,psnr_max,ssim,network_share,cpu_seconds," \
    "frames_per_second,dynamic_psnr,objective"

static adcgs_status write_curves(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(csv_open(&file, sweep, "sweep.csv", "curve," ROW_COLUMNS, error));
    for (int i = 0; i < plan->n_curves; i++)
        for (int j = 0; j < plan->curve[i].n; j++) {
            adcgs_sweep_row row;
            if (adcgs_sweep_point(&row, plan, &plan->curve[i], j))
                csv_row(file.file, &row);
        }
    return adcgs_atomic_commit(&file, error);
}

static adcgs_status write_stages(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(csv_open(&file, sweep, "ablation.csv", "stage," ROW_COLUMNS, error));
    for (int i = 0; i < plan->n_stages; i++) {
        adcgs_sweep_row row;
        if (adcgs_sweep_row_make(&row, plan, plan->stage[i].name, plan->stage[i].cell, plan->stage[i].size))
            csv_row(file.file, &row);
    }
    return adcgs_atomic_commit(&file, error);
}

static adcgs_status write_portions(const adcgs_sweep *sweep, const adcgs_sweep_shown *shown, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(csv_open(&file, sweep, "portions.csv", "run,of,count,bytes,psnr,dynamic_psnr", error));
    for (int i = 0; i < shown->n_portions; i++) {
        const adcgs_sweep_portion *const p = &shown->portion[i];
        if (!p->is_known)
            continue;
        fprintf(file.file, "%s,%s,%d", shown->run->tag, adcgs_portion_name(p->kind), p->count);
        csv_number(file.file, p->bytes, 0);
        csv_number(file.file, p->psnr, 4);
        csv_number(file.file, p->moving, 4);
        fprintf(file.file, "\n");
    }
    return adcgs_atomic_commit(&file, error);
}

static adcgs_status write_views(const adcgs_sweep *sweep, const adcgs_sweep_shown *shown, adcgs_error *error)
{
    adcgs_atomic file;
    ADCGS_TRY(csv_open(&file, sweep, "views.csv", "run,camera,view,time,psnr,dynamic_psnr", error));
    for (int i = 0; i < shown->n_views; i++) {
        const adcgs_sweep_view *const v = &shown->view[i];
        fprintf(file.file, "%s,%d,", shown->run->tag, v->camera);
        adcgs_text_cell(file.file, v->name);
        csv_number(file.file, v->time, 6);
        csv_number(file.file, v->psnr, 4);
        csv_number(file.file, v->moving, 4);
        fprintf(file.file, "\n");
    }
    return adcgs_atomic_commit(&file, error);
}

/* ---- JSON ---- */

static void json_spread(adcgs_json *json, const char *key, const adcgs_spread *s)
{
    adcgs_json_open(json, key, '{');
    adcgs_json_real(json, "mean", s->mean);
    adcgs_json_real(json, "min", s->min);
    adcgs_json_real(json, "max", s->max);
    adcgs_json_close(json);
}

static void json_row(adcgs_json *json, const adcgs_sweep_row *r)
{
    if (r->lambda >= 0)
        adcgs_json_real(json, "lambda", r->lambda);
    if (*r->choice)
        adcgs_json_string(json, "choice", r->choice);
    adcgs_json_int(json, "seeds", r->bytes.n);
    json_spread(json, "bytes", &r->bytes);
    json_spread(json, "psnr", &r->psnr);
    adcgs_json_real(json, "dynamic_psnr", r->moving.mean);
    adcgs_json_real(json, "ssim", r->ssim.mean);
    if (isfinite(r->networks))
        adcgs_json_real(json, "network_share", r->networks);
    adcgs_json_real(json, "cpu_seconds", r->seconds.mean);
    adcgs_json_real(json, "frames_per_second", r->speed.mean);
    if (isfinite(r->objective.mean))
        adcgs_json_real(json, "objective", r->objective.mean);
}

static void json_comparison(adcgs_json *json, const adcgs_sweep_plan *plan, const adcgs_sweep_curve *curve)
{
    const adcgs_comparison c = adcgs_sweep_compare(plan, curve);
    adcgs_json_open(json, "comparison", '{');
    adcgs_json_real(json, "bd_rate", c.bd_rate);
    adcgs_json_real(json, "bd_rate_moving", c.bd_rate_moving);
    adcgs_json_bool(json, "above", c.above);
    adcgs_json_int(json, "points_compared", c.compared);
    adcgs_json_int(json, "points_beyond", c.beyond);
    adcgs_json_real(json, "least_margin", c.margin);
    adcgs_json_real(json, "times_smaller", c.smaller);
    adcgs_json_close(json);
}

static void json_curves(adcgs_json *json, const adcgs_sweep_plan *plan)
{
    adcgs_json_open(json, "curves", '[');
    for (int i = 0; i < plan->n_curves; i++) {
        const adcgs_sweep_curve *const curve = &plan->curve[i];
        adcgs_json_open(json, NULL, '{');
        adcgs_json_string(json, "name", curve->name);
        adcgs_json_string(json, "note", curve->note);
        adcgs_json_bool(json, "yardstick", curve->yardstick);
        adcgs_json_open(json, "points", '[');
        for (int j = 0; j < curve->n; j++) {
            adcgs_sweep_row row;
            if (!adcgs_sweep_point(&row, plan, curve, j))
                continue;
            adcgs_json_open(json, NULL, '{');
            json_row(json, &row);
            adcgs_json_close(json);
        }
        adcgs_json_close(json);
        if (i)
            json_comparison(json, plan, curve);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

static void json_stages(adcgs_json *json, const adcgs_sweep_plan *plan)
{
    adcgs_json_open(json, "ablation", '[');
    for (int i = 0; i < plan->n_stages; i++) {
        adcgs_sweep_row row;
        if (!adcgs_sweep_row_make(&row, plan, plan->stage[i].name, plan->stage[i].cell, plan->stage[i].size))
            continue;
        adcgs_json_open(json, NULL, '{');
        adcgs_json_string(json, "stage", plan->stage[i].name);
        adcgs_json_string(json, "stored", plan->stage[i].size == ADCGS_FIGURE_RAW ? "uncompressed" : "stream");
        json_row(json, &row);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

static void json_runs(adcgs_json *json, const adcgs_sweep_plan *plan)
{
    static const char *const names[ADCGS_FIGURE_COUNT] = {"bytes",
                                                          "bytes_with_32_bit_weights",
                                                          "uncompressed_bytes",
                                                          "zstd_bytes",
                                                          "xz_bytes",
                                                          "network_bytes",
                                                          "position_bytes",
                                                          "base_bytes",
                                                          "detail_bytes",
                                                          "other_bytes",
                                                          "psnr",
                                                          "ssim",
                                                          "dynamic_psnr",
                                                          "cpu_seconds",
                                                          "frames_per_second",
                                                          "objective"};
    adcgs_json_open(json, "runs", '[');
    for (int i = 0; i < plan->n_runs; i++) {
        const adcgs_sweep_run *const run = &plan->run[i];
        if (run->beginning || run->state != ADCGS_RUN_DONE)
            continue;
        adcgs_json_open(json, NULL, '{');
        adcgs_json_string(json, "name", run->tag);
        if (run->seed >= 0)
            adcgs_json_real(json, "seed", run->seed);
        for (int j = 0; j < ADCGS_FIGURE_COUNT; j++)
            if (isfinite(run->figure[j]))
                adcgs_json_real(json, names[j], run->figure[j]);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
}

/** The measurements of the representative run. */
static void json_shown(adcgs_json *json, const adcgs_sweep_shown *shown)
{
    adcgs_json_open(json, "shown", '{');
    adcgs_json_string(json, "run", shown->run->tag);
    adcgs_json_open(json, "portions", '[');
    for (int i = 0; i < shown->n_portions; i++) {
        const adcgs_sweep_portion *const p = &shown->portion[i];
        if (!p->is_known)
            continue;
        adcgs_json_open(json, NULL, '{');
        adcgs_json_string(json, "of", adcgs_portion_name(p->kind));
        adcgs_json_int(json, "count", p->count);
        adcgs_json_real(json, "bytes", p->bytes);
        adcgs_json_real(json, "dynamic_psnr", p->moving);
        adcgs_json_real(json, "psnr", p->psnr);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
    adcgs_json_open(json, "views", '[');
    for (int i = 0; i < shown->n_views; i++) {
        const adcgs_sweep_view *const v = &shown->view[i];
        adcgs_json_open(json, NULL, '{');
        adcgs_json_int(json, "camera", v->camera);
        adcgs_json_string(json, "view", v->name);
        adcgs_json_real(json, "time", v->time);
        adcgs_json_real(json, "dynamic_psnr", v->moving);
        adcgs_json_real(json, "psnr", v->psnr);
        adcgs_json_close(json);
    }
    adcgs_json_close(json);
    adcgs_json_close(json);
}

static void json_sweep(adcgs_json *json, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan)
{
    const adcgs_curve_facts facts = adcgs_sweep_facts(plan);
    adcgs_json_open(json, NULL, '{');
    adcgs_json_string(json, "scene", sweep->scene);
    adcgs_json_string(json, "preset", sweep->preset ? sweep->preset : "");
    adcgs_json_string(json, "set", sweep->set ? sweep->set : "");
    adcgs_json_int(json, "iterations", sweep->iterations);
    adcgs_json_open(json, "curve", '{');
    adcgs_json_int(json, "points", facts.n);
    adcgs_json_bool(json, "monotone", facts.monotone);
    adcgs_json_real(json, "span", facts.span);
    adcgs_json_close(json);
    json_curves(json, plan);
    json_stages(json, plan);
    json_runs(json, plan);
    if (plan->shown.run)
        json_shown(json, &plan->shown);
    adcgs_json_close(json);
}

static adcgs_status write_json(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_atomic file;
    adcgs_json json;
    snprintf(path, sizeof path, "%s/sweep.json", sweep->directory);
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    adcgs_json_init(&json);
    json_sweep(&json, sweep, plan);
    const adcgs_status status = adcgs_json_write(&json, file.file, path, error);
    if (status == ADCGS_OK)
        return adcgs_atomic_commit(&file, error);
    adcgs_atomic_abort(&file);
    return status;
}

adcgs_status adcgs_sweep_write_tables(const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_error *error)
{
    ADCGS_TRY(write_curves(sweep, plan, error));
    if (plan->n_stages)
        ADCGS_TRY(write_stages(sweep, plan, error));
    if (plan->shown.n_portions)
        ADCGS_TRY(write_portions(sweep, &plan->shown, error));
    if (plan->shown.n_views)
        ADCGS_TRY(write_views(sweep, &plan->shown, error));
    return write_json(sweep, plan, error);
}
