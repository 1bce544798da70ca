/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A sweep on many machines: the list, a single run, and collecting the results. */
#include "config.h"

#include "apps/sweep/sweep_many.h"

#include "apps/sweep/sweep_run.h"
#include "system/atomic.h"
#include "system/file.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define WORDS "command.txt" /* the sweep's command line, one word a line */
#define WORDS_MAX 100000    /* words of a command line; chosen by hand, not measured */
#define ALL "sweep"         /* name of the claim on all runs */
#define TABLES "tables"     /* name of the claim on the tables */

/* ---- Claims ---- */

adcgs_status adcgs_sweep_make_folder(const adcgs_sweep *sweep, adcgs_error *error)
{
    return mkdir(sweep->directory, 0777) == 0 || errno == EEXIST
               ? ADCGS_OK
               : adcgs_fail(error, ADCGS_ERR_IO, "%s: cannot make the folder: %s", sweep->directory, strerror(errno));
}

/** Names the file of a claim. */
static void name_claim(char path[ADCGS_SWEEP_PATH], const adcgs_sweep *sweep, const char *name)
{
    snprintf(path, ADCGS_SWEEP_PATH, "%s/%s.running", sweep->directory, name);
}

static adcgs_status claim(adcgs_claim **c, const adcgs_sweep *sweep, const char *name, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    name_claim(path, sweep, name);
    return adcgs_claim_take(c, path, name, error);
}

static adcgs_status absent(const adcgs_sweep *sweep, const char *name, adcgs_error *error)
{
    char path[ADCGS_SWEEP_PATH];
    name_claim(path, sweep, name);
    return adcgs_claim_absent(path, name, error);
}

/* Each process claims first and checks afterwards, here and in a single run. Of two processes at the same time, at least one
   sees the other. */
adcgs_status adcgs_sweep_claim_all(adcgs_sweep_claims *claims, const adcgs_sweep *sweep, const adcgs_sweep_plan *plan,
                                   adcgs_error *error)
{
    *claims = (adcgs_sweep_claims){NULL, NULL};
    ADCGS_TRY(claim(&claims->runs, sweep, ALL, error));
    ADCGS_TRY(claim(&claims->tables, sweep, TABLES, error));
    for (int i = 0; i < plan->n_runs; i++)
        ADCGS_TRY(absent(sweep, plan->run[i].tag, error));
    return ADCGS_OK;
}

void adcgs_sweep_unclaim(adcgs_sweep_claims *claims)
{
    adcgs_claim_drop(&claims->tables);
    adcgs_claim_drop(&claims->runs);
}

/* ---- The stored command line ---- */

static void keep_word(FILE *file, const char *before, const char *word, int *lines)
{
    *lines += strchr(word, '\n') != NULL;
    fprintf(file, "%s%s\n", before, word);
}

adcgs_status adcgs_sweep_keep_words(const adcgs_sweep_request *request, adcgs_error *error)
{
    const adcgs_sweep_words *const w = &request->words;
    char path[ADCGS_SWEEP_PATH];
    adcgs_atomic file;
    int lines = 0;
    snprintf(path, sizeof path, "%s/" WORDS, request->sweep.directory);
    ADCGS_TRY(adcgs_atomic_open(&file, path, error));
    for (int i = 0; i < w->n; i++) {
        keep_word(file.file, "--", w->option[i].name, &lines);
        if (w->option[i].value)
            keep_word(file.file, "", w->option[i].value, &lines);
    }
    keep_word(file.file, "", "--output", &lines);
    keep_word(file.file, "", request->sweep.directory, &lines);
    keep_word(file.file, "", "--", &lines);
    keep_word(file.file, "", request->sweep.scene, &lines);
    if (!lines)
        return adcgs_atomic_commit(&file, error);
    adcgs_atomic_abort(&file);
    return adcgs_fail(error, ADCGS_ERR_USAGE, "expected names and values without line breaks");
}

adcgs_status adcgs_sweep_recall(adcgs_sweep_past *past, const char *folder, adcgs_error *error)
{
    static char program[] = "adcgs-sweep";
    char path[ADCGS_SWEEP_PATH];
    size_t size;
    snprintf(path, sizeof path, "%s/" WORDS, folder);
    ADCGS_TRY(adcgs_file_load_text(&past->text, &size, path, WORDS_MAX, error));
    past->argv[past->argc++] = program;
    for (char *at = (char *)past->text, *end; *at; at = end + 1) {
        end = strchr(at, '\n');
        if (!end || past->argc + 1 == (int)ADCGS_COUNTOF(past->argv))
            return adcgs_fail(error, ADCGS_ERR_DATA, "%s: line %d: expected the words of a command, one a line", path,
                              past->argc);
        *end = '\0';
        past->argv[past->argc++] = at;
    }
    return ADCGS_OK;
}

void adcgs_sweep_forget(adcgs_sweep_past *past)
{
    free(past->text);
    *past = (adcgs_sweep_past){.argc = 0};
}

/* ---- List ---- */

int adcgs_sweep_list(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan, const char *called)
{
    const adcgs_sweep *const sweep = &request->sweep;
    adcgs_error error;
    if (adcgs_sweep_keep_words(request, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    for (int i = 0; i < plan->n_runs; i++) {
        adcgs_sweep_run *const run = &plan->run[i];
        if (run->beginning || (sweep->resume && adcgs_sweep_load(sweep, run, &error) == ADCGS_OK))
            continue;
        adcgs_sweep_print_line(stdout, called, request, run->tag);
        fputc('\n', stdout);
    }
    return adcgs_cli_leave(cli, 0);
}

/* ---- One run ---- */

static int find_run(const adcgs_sweep_plan *plan, const char *tag)
{
    for (int i = 0; i < plan->n_runs; i++)
        if (!strcmp(plan->run[i].tag, tag))
            return i;
    return -1;
}

/** Keeps only the run in the plan, and its beginning if that has been trained: it need not be. */
static void keep_only(const adcgs_sweep *sweep, adcgs_sweep_plan *plan, int index)
{
    adcgs_error ignored;
    adcgs_sweep_run run = plan->run[index], from = {.state = ADCGS_RUN_WAITS};
    if (run.from >= 0)
        from = plan->run[run.from];
    const int begun = run.from >= 0 && adcgs_sweep_load(sweep, &from, &ignored) == ADCGS_OK;
    run.from = begun ? 1 : -1;
    plan->run[0] = run;
    if (begun)
        plan->run[1] = from;
    plan->n_runs = 1 + begun;
}

/** Trains and measures the run, with the claim held. */
static int run_claimed(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan, const adcgs_claim *claim)
{
    adcgs_error error;
    if (absent(sweep, ALL, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    if (adcgs_sweep_take_finished(cli, sweep, plan) && plan->run[0].state == ADCGS_RUN_DONE)
        return 0;
    const int code = adcgs_sweep_run_all(cli, sweep, plan, 1);
    if (adcgs_claim_check(claim, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    return code;
}

int adcgs_sweep_run_one(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan)
{
    adcgs_sweep sweep = request->sweep;
    adcgs_claim *at = NULL;
    adcgs_error error;
    const int index = find_run(plan, request->run);
    if (index < 0)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "--run %s: expected one of the runs that --list prints", request->run);
    sweep.resume = 1;
    if (claim(&at, &sweep, plan->run[index].tag, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    keep_only(&sweep, plan, index);
    const int code = run_claimed(cli, &sweep, plan, at);
    adcgs_claim_drop(&at);
    return code;
}

/* ---- Collecting ---- */

/** Reports a run that is not finished, and its state. */
static void name_missing(const adcgs_cli *cli, const adcgs_sweep *sweep, const adcgs_sweep_run *run)
{
    char path[ADCGS_SWEEP_PATH];
    adcgs_error error;
    if (absent(sweep, run->tag, &error) != ADCGS_OK) {
        adcgs_cli_error(cli, ADCGS_OK, "%s: not finished: %s", run->tag, error.text);
        return;
    }
    snprintf(path, sizeof path, "%s/%s.log", sweep->directory, run->tag);
    if (access(path, F_OK))
        adcgs_cli_error(cli, ADCGS_OK, "%s: not begun", run->tag);
    else
        adcgs_cli_error(cli, ADCGS_OK, "%s: begun, not finished, and no process works on it; see %s", run->tag, path);
}

int adcgs_sweep_collect(const adcgs_cli *cli, const adcgs_sweep *sweep, adcgs_sweep_plan *plan)
{
    adcgs_claim *at = NULL;
    adcgs_error error;
    int missing = 0;
    if (claim(&at, sweep, TABLES, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_sweep_take_finished(cli, sweep, plan);
    for (int i = 0; i < plan->n_runs; i++)
        if (!plan->run[i].beginning && plan->run[i].state != ADCGS_RUN_DONE) {
            name_missing(cli, sweep, &plan->run[i]);
            missing = 1;
        }
    const int code = adcgs_sweep_finish(cli, sweep, plan);
    adcgs_claim_drop(&at);
    return code ? code : missing;
}
