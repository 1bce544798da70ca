/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-sweep: encodes a grid, decodes and measures each stream, and makes a table and a chart. */
#include "config.h"

#include "apps/sweep/sweep_many.h"
#include "apps/sweep/sweep_options.h"
#include "apps/sweep/sweep_run.h"
#include "cli/cli.h"
#include "media/kind.h"
#include "system/interrupt.h"

#include <stdlib.h>
#include <unistd.h>

/** The folder of this program and its siblings. */
static void find_programs(const char *argv0, char *out, size_t size)
{
    const ssize_t n = readlink("/proc/self/exe", out, size - 1);
    if (n > 0)
        out[n] = '\0';
    else
        snprintf(out, size, "%s", argv0);
    char *const slash = strrchr(out, '/');
    if (slash)
        *slash = '\0';
    else
        snprintf(out, size, ".");
}

/* ---- Tasks ---- */

static int sweep_all(const adcgs_cli *cli, const adcgs_sweep_request *request, adcgs_sweep_plan *plan)
{
    const adcgs_sweep *const sweep = &request->sweep;
    adcgs_error error;
    adcgs_sweep_claims claims;
    int code = 0;
    if (adcgs_sweep_claim_all(&claims, sweep, plan, &error) != ADCGS_OK || adcgs_sweep_keep_words(request, &error) != ADCGS_OK)
        code = adcgs_cli_fail(cli, &error);
    else {
        if (sweep->resume)
            adcgs_sweep_take_finished(cli, sweep, plan);
        const int ran = adcgs_sweep_run_all(cli, sweep, plan, request->jobs), written = adcgs_sweep_finish(cli, sweep, plan);
        code = ADCGS_MAX(ran, written);
    }
    adcgs_sweep_unclaim(&claims);
    return code;
}

static int obey(const adcgs_cli *cli, const adcgs_sweep_request *request, const char *called)
{
    const adcgs_sweep *const sweep = &request->sweep;
    adcgs_error error;
    adcgs_sweep_plan *const plan = calloc(1, sizeof *plan);
    int code = 0;
    if (!plan)
        return adcgs_cli_error(cli, ADCGS_ERR_MEMORY, "out of memory");
    adcgs_interrupt_catch(1);
    if ((sweep->scene && adcgs_kind_check(sweep->scene, ADCGS_WANT_SCENE, &error) != ADCGS_OK) ||
        adcgs_sweep_plan_make(plan, sweep, &error) != ADCGS_OK || adcgs_sweep_add_against(plan, sweep, &error) != ADCGS_OK ||
        adcgs_sweep_add_tables(plan, sweep->tables, &error) != ADCGS_OK || adcgs_sweep_make_folder(sweep, &error) != ADCGS_OK)
        code = adcgs_cli_fail(cli, &error);
    else if (request->list)
        code = adcgs_sweep_list(cli, request, plan, called);
    else if (request->run)
        code = adcgs_sweep_run_one(cli, request, plan);
    else
        code = request->collect ? adcgs_sweep_collect(cli, sweep, plan) : sweep_all(cli, request, plan);
    adcgs_sweep_plan_clear(plan);
    free(plan);
    return code;
}

/* ---- Command line ---- */

static const adcgs_cli program = {
    .program = "adcgs-sweep",
    .operands = "SCENE",
    .summary = "Encode a scene at several rates, measure each decoded file, plot the curve.",
    .details = "Runs adcgs-enc, adcgs-eval and adcgs-info from the folder of adcgs-sweep itself.",
    .min_operands = 0, /* none with --collect */
    .max_operands = 1,
};

/** The sweep's command line, for its page. NULL on allocation failure. */
static char *write_command(const adcgs_sweep_request *request)
{
    char *text = NULL;
    size_t size = 0;
    FILE *const memory = open_memstream(&text, &size);
    if (!memory)
        return NULL;
    adcgs_sweep_print_line(memory, program.program, request, NULL);
    return fclose(memory) ? (free(text), NULL) : text;
}

/** Replaces the request that names a folder by the folder's own request. *past has to outlive it. */
static int recall(adcgs_cli *cli, adcgs_sweep_request *request, adcgs_sweep_past *past)
{
    adcgs_error error;
    const char *const folder = request->collect;
    if (adcgs_sweep_recall(past, folder, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    *request = (adcgs_sweep_request){.quiet = request->quiet};
    const int code = adcgs_sweep_parse(cli, request, past->argc, past->argv);
    if (code < 0 && (request->collect || request->list || request->run))
        return adcgs_cli_error(cli, ADCGS_ERR_DATA, "%s/command.txt: expected a sweep of all runs", folder);
    request->collect = folder;
    request->sweep.directory = folder;
    request->sweep.resume = 1;
    return code;
}

int main(int argc, char **argv)
{
    char programs[ADCGS_SWEEP_PATH];
    adcgs_sweep_request request = {.jobs = 1};
    adcgs_sweep_past past = {.argc = 0};
    adcgs_cli cli = program;
    cli.quiet = &request.quiet;
    int code = adcgs_sweep_parse(&cli, &request, argc, argv);
    if (code < 0 && request.collect)
        code = recall(&cli, &request, &past);
    if (code < 0) {
        char *const command = write_command(&request);
        find_programs(argv[0], programs, sizeof programs);
        request.sweep.programs = programs;
        request.sweep.command = command ? command : program.program;
        code = obey(&cli, &request, argv[0]);
        free(command);
    }
    adcgs_sweep_forget(&past);
    return code;
}
