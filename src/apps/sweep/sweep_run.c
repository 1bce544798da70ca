/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The runs of adcgs-sweep, each in a child process, several at a time, and their progress. */
#include "config.h"

#include "apps/sweep/sweep_run.h"
#include "system/interrupt.h"

#include <errno.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static int start(const adcgs_cli *cli, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan, adcgs_sweep_run *run)
{
    const pid_t child = fork();
    if (child == 0) {
        adcgs_error error;
        const adcgs_sweep_run *const from = run->from >= 0 ? &plan->run[run->from] : NULL;
        const adcgs_status status = adcgs_sweep_execute(sweep, run, from, &error);
        _exit(status == ADCGS_OK ? 0 : adcgs_cli_fail(cli, &error));
    }
    run->child = child;
    run->state = child < 0 ? ADCGS_RUN_FAILED : ADCGS_RUN_RUNS;
    return child < 0 ? adcgs_cli_error(cli, ADCGS_ERR_IO, "cannot start a process: %s", strerror(errno)) : 0;
}

/** A run that can start now, NULL if there is none. A beginning comes when the first run that needs it would start. */
static adcgs_sweep_run *next_run(adcgs_sweep_plan *plan)
{
    for (int i = 0; i < plan->n_runs; i++) {
        adcgs_sweep_run *const run = &plan->run[i];
        if (run->beginning || run->state != ADCGS_RUN_WAITS)
            continue;
        adcgs_sweep_run *const from = run->from >= 0 ? &plan->run[run->from] : NULL;
        if (!from || from->state == ADCGS_RUN_DONE)
            return run;
        if (from->state == ADCGS_RUN_WAITS)
            return from;
        if (from->state == ADCGS_RUN_FAILED)
            run->state = ADCGS_RUN_FAILED;
    }
    return NULL;
}

static void say(const adcgs_cli *cli, const adcgs_sweep_run *r, const char *how)
{
    if (r->beginning)
        adcgs_cli_note(cli, "%s: trained%s", r->tag, how);
    else
        adcgs_cli_note(cli, "%s: %.0f bytes, %.2f dB PSNR, %.4f SSIM%s", r->tag, r->figure[ADCGS_FIGURE_BYTES],
                       r->figure[ADCGS_FIGURE_PSNR], r->figure[ADCGS_FIGURE_SSIM], how);
}

static int count_running(const adcgs_sweep_plan *plan)
{
    int n = 0;
    for (int i = 0; i < plan->n_runs; i++)
        n += plan->run[i].state == ADCGS_RUN_RUNS;
    return n;
}

/** Waits until a child ends, and shows progress. */
static pid_t wait_for_child(const adcgs_cli *cli, const adcgs_sweep_plan *plan, int *state)
{
    const struct timespec pause = {.tv_nsec = 50000000};
    const double start = adcgs_seconds();
    adcgs_progress progress;
    pid_t child;
    int done = 0;
    for (int i = 0; i < plan->n_runs; i++)
        done += plan->run[i].state == ADCGS_RUN_DONE;
    adcgs_progress_init(&progress, cli);
    while ((child = waitpid(-1, state, WNOHANG)) == 0) {
        adcgs_progress_show(&progress, "%d of %d runs done, %d running since %.0f s", done, plan->n_runs, count_running(plan),
                            adcgs_seconds() - start);
        nanosleep(&pause, NULL);
    }
    adcgs_progress_clear(&progress);
    return child;
}

/** Waits for one child and takes its result; returns its exit code. */
static int reap(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan)
{
    int state = 0, i = 0;
    const pid_t child = wait_for_child(cli, plan, &state);
    while (i < plan->n_runs && (plan->run[i].state != ADCGS_RUN_RUNS || plan->run[i].child != child))
        i++;
    if (child < 0 || i == plan->n_runs)
        return 0;
    adcgs_sweep_run *const run = &plan->run[i];
    const int code = WIFEXITED(state) ? WEXITSTATUS(state) : 128;
    adcgs_error error;
    run->state = ADCGS_RUN_FAILED;
    if (code == 0 && adcgs_sweep_load(sweep, run, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    if (code == 0)
        say(cli, run, "");
    return code;
}

int adcgs_sweep_run_all(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int jobs)
{
    int worst = 0;
    for (;;) {
        adcgs_sweep_run *run;
        int code = 0;
        while (code == 0 && count_running(plan) < jobs && !adcgs_interrupted() && (run = next_run(plan)))
            code = start(cli, sweep, plan, run);
        worst = ADCGS_MAX(worst, code);
        if (!count_running(plan))
            break;
        code = reap(cli, sweep, plan);
        worst = ADCGS_MAX(worst, code);
    }
    return adcgs_interrupted() ? ADCGS_MAX(worst, 3) : worst;
}

/* ---- Finished runs ---- */

int adcgs_sweep_take_finished(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan)
{
    int n = 0;
    for (int i = 0; i < plan->n_runs; i++) {
        adcgs_error ignored;
        if (adcgs_sweep_load(sweep, &plan->run[i], &ignored) != ADCGS_OK)
            continue;
        say(cli, &plan->run[i], " (from an earlier sweep)");
        n++;
    }
    return n;
}

/* ---- Results ---- */

static int show_one(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan)
{
    adcgs_error error;
    adcgs_progress progress;
    if (adcgs_interrupted())
        return 3;
    adcgs_status status = adcgs_sweep_show(sweep, plan, &error);
    if (status == ADCGS_OK)
        status = adcgs_sweep_list_portions(sweep, plan, &error);
    adcgs_progress_init(&progress, cli);
    for (int i = 0; status == ADCGS_OK && i < plan->shown.n_portions && !adcgs_interrupted(); i++) {
        adcgs_progress_show(&progress, "%s: measuring part %d of %d", plan->shown.run->tag, i + 1, plan->shown.n_portions);
        status = adcgs_sweep_measure_portion(sweep, plan, i, &error);
    }
    adcgs_progress_clear(&progress);
    if (adcgs_interrupted())
        return 3;
    return status == ADCGS_OK ? 0 : adcgs_cli_fail(cli, &error);
}

static int write_all(const adcgs_cli *cli, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan)
{
    adcgs_error error;
    unsigned charts = 0;
    if (adcgs_sweep_write_tables(sweep, plan, &error) != ADCGS_OK || adcgs_sweep_draw(sweep, plan, &charts, &error) != ADCGS_OK ||
        adcgs_sweep_write_page(sweep, plan, charts, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_sweep_print(stdout, plan);
    if (adcgs_cli_flush(&error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_cli_note(cli, "wrote %s/index.html, sweep.csv, sweep.json%s%s%s%s", sweep->directory,
                   plan->n_stages ? ", ablation.csv" : "", plan->shown.n_portions ? ", portions.csv" : "",
                   plan->shown.n_views ? ", views.csv" : "",
                   charts           ? ", charts as .svg and .pdf"
                   : plan->n_curves ? "; no chart: install gnuplot"
                                    : "");
    return 0;
}

int adcgs_sweep_finish(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan)
{
    const int shown = show_one(cli, sweep, plan), written = write_all(cli, sweep, plan);
    return ADCGS_MAX(shown, written);
}
