/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The contents of a sweep: each training once, for all its uses. */
#include "config.h"

#include "apps/sweep/sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- Runs ---- */

static void name_run(adcgs_sweep_run *r)
{
    char *at = r->tag, *const end = r->tag + sizeof r->tag;
    if (r->beginning || r->uncompressed)
        at += snprintf(at, (size_t)(end - at), r->beginning ? "beginning" : "uncompressed");
    else if (r->lambda < 0)
        at += snprintf(at, (size_t)(end - at), "lambda-own");
    else
        at += snprintf(at, (size_t)(end - at), "lambda-%.9g", r->lambda);
    if (*r->choice)
        at += snprintf(at, (size_t)(end - at), "-%s", r->choice);
    if (r->seed >= 0)
        at += snprintf(at, (size_t)(end - at), "-seed-%.0f", r->seed);
    if (*r->without)
        snprintf(at, (size_t)(end - at), "-without-%s", r->without);
    for (char *c = r->tag; *c; c++)
        *c = *c == ',' ? '+' : *c == ' ' || *c == '=' ? '-' : *c;
}

/** Returns the index of the run, added to the plan if there is none of its tag; -1 on allocation failure. */
static int add_run(adcgs_sweep_plan *plan, adcgs_sweep_run run)
{
    run.lambda = run.beginning || run.uncompressed ? -1 : run.lambda; /* lambda has no effect there */
    name_run(&run);
    for (int i = 0; i < plan->n_runs; i++)
        if (!strcmp(plan->run[i].tag, run.tag))
            return i;
    if (plan->n_runs == plan->capacity) {
        const int capacity = plan->capacity ? 2 * plan->capacity : 64;
        adcgs_sweep_run *const more = realloc(plan->run, (size_t)capacity * sizeof *more);
        if (!more)
            return -1;
        plan->run = more;
        plan->capacity = capacity;
    }
    run.from = -1;
    for (int i = 0; i < ADCGS_FIGURE_COUNT; i++)
        run.figure[i] = (double)NAN;
    plan->run[plan->n_runs] = run;
    return plan->n_runs++;
}

/** Adds a cell of runs like the given one, for each seed; -1 on allocation failure. */
static int add_cell(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_sweep_run like)
{
    adcgs_sweep_cell *const cell = &plan->cell[plan->n_cells];
    for (int i = 0; i < ADCGS_MAX(sweep->n_seed, 1); i++) {
        like.seed = sweep->n_seed ? sweep->seed[i] : -1;
        cell->run[cell->n] = add_run(plan, like);
        if (cell->run[cell->n++] < 0)
            return -1;
    }
    return plan->n_cells++;
}

/** The parts left out before lambda has an effect. The weights' steps come later. */
static const char *left_out_early(const adcgs_sweep_run *r)
{
    return !strcmp(r->without, "weight_steps") ? "" : r->without;
}

static int share_beginning(const adcgs_sweep_run *a, const adcgs_sweep_run *b)
{
    return !strcmp(a->choice, b->choice) && a->seed == b->seed && !strcmp(left_out_early(a), left_out_early(b));
}

/** Runs that differ only in lambda, or in later stages, share their beginning. */
static adcgs_status add_beginnings(adcgs_sweep_plan *plan, adcgs_error *error)
{
    const int n = plan->n_runs;
    for (int i = 0; i < n; i++) {
        const adcgs_sweep_run run = plan->run[i];
        int family = 0;
        if (run.uncompressed || run.from >= 0 || !adcgs_sweep_choice_shares(run.choice))
            continue;
        for (int j = i; j < n; j++)
            family += !plan->run[j].uncompressed && share_beginning(&run, &plan->run[j]);
        if (family < 2)
            continue;
        adcgs_sweep_run beginning = {.beginning = 1, .seed = run.seed, .without = left_out_early(&run)};
        memcpy(beginning.choice, run.choice, sizeof run.choice);
        const int from = add_run(plan, beginning);
        if (from < 0)
            return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the list of runs");
        for (int j = i; j < n; j++)
            if (!plan->run[j].uncompressed && share_beginning(&run, &plan->run[j]))
                plan->run[j].from = from;
    }
    return ADCGS_OK;
}

/* ---- Curves ---- */

adcgs_sweep_curve *adcgs_sweep_add_curve(adcgs_sweep_plan *plan, const char *name, const char *note, adcgs_figure size,
                                         int yardstick)
{
    adcgs_sweep_curve *const curve = &plan->curve[plan->n_curves++];
    snprintf(curve->name, sizeof curve->name, "%s", name);
    snprintf(curve->note, sizeof curve->note, "%s", note);
    curve->size = size;
    curve->yardstick = yardstick;
    return curve;
}

/** Adds a cell for each lambda; 0 on allocation failure. */
static int add_lambdas(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_sweep_curve *curve, adcgs_sweep_run like)
{
    for (int i = 0; i < sweep->n_lambda; i++) {
        like.lambda = sweep->lambda[i];
        curve->cell[curve->n] = add_cell(plan, sweep, like);
        if (curve->cell[curve->n++] < 0)
            return 0;
    }
    return 1;
}

/** Adds a curve of one point; 0 if the cell could not be made. */
static int add_point(adcgs_sweep_plan *plan, const char *name, const char *note, adcgs_figure size, int cell)
{
    adcgs_sweep_curve *const curve = adcgs_sweep_add_curve(plan, name, note, size, 1);
    curve->cell[curve->n++] = cell;
    return cell >= 0;
}

static int add_own_curves(adcgs_sweep_plan *plan, const adcgs_sweep *sweep)
{
    for (int i = 0; i < adcgs_sweep_grid_count(&sweep->grid); i++) {
        adcgs_sweep_run like = {.without = ""};
        adcgs_sweep_grid_choice(like.choice, &sweep->grid, i);
        adcgs_sweep_curve *const curve = adcgs_sweep_add_curve(plan, "adcgs", "the stream on disk", ADCGS_FIGURE_BYTES, 0);
        if (*like.choice)
            snprintf(curve->name, sizeof curve->name, "adcgs %s", like.choice);
        if (!add_lambdas(plan, sweep, curve, like))
            return 0;
    }
    return 1;
}

/**
 * Adds the uncompressed yardsticks, also with general-purpose compressors. The uncompressed model is reduced already, by pruning
 * of primitives and units, which belongs to compression. The whole model is that of the method without any compression.
 */
static int add_uncompressed(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_sweep_run like)
{
    adcgs_sweep_run whole = like;
    whole.without = "removal";
    const int cell = add_cell(plan, sweep, like);
    return add_point(plan, "uncompressed", "trained without rate and rounding, 4 bytes a number", ADCGS_FIGURE_RAW, cell) &&
           add_point(plan, "whole uncompressed", "the same, without removal of primitives and units", ADCGS_FIGURE_RAW,
                     add_cell(plan, sweep, whole)) &&
           add_point(plan, "zstd -19", "the uncompressed file by zstd -19", ADCGS_FIGURE_ZSTD, cell) &&
           add_point(plan, "xz -9e", "the uncompressed file by xz -9e", ADCGS_FIGURE_XZ, cell);
}

static int add_gaussians(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_sweep_run like)
{
    adcgs_sweep_curve *const curve =
        adcgs_sweep_add_curve(plan, "per Gaussian", "each primitive with features of its own, deformed by itself",
                              ADCGS_FIGURE_BYTES, 1);
    like.without = "anchors";
    if (!add_lambdas(plan, sweep, curve, like))
        return 0;
    like.uncompressed = 1;
    return add_point(plan, "per Gaussian uncompressed", "the same without rate and rounding, 4 bytes a number", ADCGS_FIGURE_RAW,
                     add_cell(plan, sweep, like));
}

static int add_yardsticks(adcgs_sweep_plan *plan, const adcgs_sweep *sweep)
{
    adcgs_sweep_run like = {.without = ""};
    adcgs_sweep_grid_choice(like.choice, &sweep->grid, 0);
    adcgs_sweep_run plain = like;
    plain.uncompressed = 1;
    if (sweep->yardsticks & ADCGS_YARD_NETWORKS) {
        adcgs_sweep_curve *const curve =
            adcgs_sweep_add_curve(plan, "32-bit networks (same PSNR)",
                                  "the points with 4 bytes for each weight, as the paper counts", ADCGS_FIGURE_NETWORKS32, 1);
        curve->n = plan->curve[0].n;
        memcpy(curve->cell, plan->curve[0].cell, sizeof curve->cell);
    }
    return (!(sweep->yardsticks & ADCGS_YARD_UNCOMPRESSED) || add_uncompressed(plan, sweep, plain)) &&
           (!(sweep->yardsticks & ADCGS_YARD_GAUSSIANS) || add_gaussians(plan, sweep, like));
}

/* ---- Ablation ---- */

static int add_stages(adcgs_sweep_plan *plan, const adcgs_sweep *sweep)
{
    static const struct {
        const char *name, *without;
        int uncompressed;
        const char *k;
    } stages[] = {{"base", "coarse,fine,rate,densification", 1, NULL},
                  {"+ coarse deformation", "fine,rate,densification", 1, NULL},
                  {"+ fine deformation", "rate,densification", 1, NULL},
                  {"+ rate-distortion", "densification", 0, NULL},
                  {"+ densification", "", 0, NULL},
                  {"K = 5", "", 0, "5"},
                  {"K = 10", "", 0, "10"},
                  {"K = 15", "", 0, "15"},
                  {"32-bit networks", "weight_steps", 0, NULL}};
    for (size_t i = 0; i < ADCGS_COUNTOF(stages); i++) {
        adcgs_sweep_run like = {.lambda = sweep->n_lambda ? sweep->lambda[sweep->n_lambda / 2] : -1,
                                .uncompressed = stages[i].uncompressed,
                                .without = stages[i].without};
        adcgs_sweep_grid_choice(like.choice, &sweep->grid, 0);
        if (stages[i].k)
            adcgs_sweep_choice_change(like.choice, "k", stages[i].k);
        const adcgs_figure size = stages[i].uncompressed ? ADCGS_FIGURE_RAW : ADCGS_FIGURE_BYTES;
        const int cell = add_cell(plan, sweep, like);
        if (cell < 0)
            return 0;
        plan->stage[plan->n_stages++] = (adcgs_sweep_stage){stages[i].name, size, cell};
    }
    return 1;
}

adcgs_status adcgs_sweep_plan_make(adcgs_sweep_plan *plan, const adcgs_sweep *sweep, adcgs_error *error)
{
    if ((sweep->n_lambda && (!add_own_curves(plan, sweep) || !add_yardsticks(plan, sweep))) ||
        (sweep->ablation && !add_stages(plan, sweep)))
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the list of runs");
    return add_beginnings(plan, error);
}

void adcgs_sweep_plan_clear(adcgs_sweep_plan *plan)
{
    free(plan->run);
    free(plan->shown.view);
    plan->shown = (adcgs_sweep_shown){.run = NULL};
    plan->run = NULL;
    plan->n_runs = plan->capacity = 0;
}
