/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-join: checks the parts of a plan and joins them. */
#include "config.h"

#include "base/cpu_detect.h"
#include "cli/cli.h"
#include "encode/encode.h"
#include "session/enc_parts.h"
#include "session/plan_parts.h"
#include "system/atomic.h"

#include <adcgs/adcgs.h>

#include <stdlib.h>
#include <unistd.h>

#define NAMED 8 /* missing parts that a message names; chosen by hand, not measured */

typedef struct join_options {
    const char *plan, *output;
    int list, threads, quiet;
} join_options;

typedef struct join_job {
    const adcgs_cli *cli;
    const join_options *o;
    adcgs_plan plan;
    char *base;
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
} join_job;

/* ---- Finding parts ---- */

/** *found: 0 if the part is missing, 1 if it is present and valid. */
static adcgs_status check_part(const join_job *j, uint32_t part, int *found, adcgs_error *error)
{
    adcgs_stream one;
    const adcgs_status status = adcgs_plan_part_load(&one, &j->plan, j->base, part, j->cpu, j->pool, found, error);
    adcgs_stream_clear(&one, NULL);
    return status;
}

static int has_begun(const join_job *j, uint32_t part)
{
    char *name;
    adcgs_error ignored;
    if (adcgs_enc_part_name(&name, j->base, part, 0, &ignored) != ADCGS_OK)
        return 0;
    const int is_there = !access(name, F_OK);
    free(name);
    return is_there;
}

/** Prints a line for each part; *code: 1 if a part is present, but invalid. */
static adcgs_status list(const join_job *j, int *code, adcgs_error *error)
{
    int before = 0;
    for (uint32_t i = 0; i < j->plan.cuts.n; i++) {
        const int follows = j->plan.segments[i].follows, waits = follows && !before;
        int found = 0;
        const adcgs_status status = check_part(j, i, &found, error);
        if (status == ADCGS_ERR_MEMORY)
            return status;
        if (status != ADCGS_OK) {
            adcgs_cli_error(j->cli, ADCGS_OK, "%s", error->text);
            *code = 1;
        }
        printf("%u %u %s %.0f\n", i + 1, follows ? i : 0,
               status != ADCGS_OK ? "bad"
               : found            ? "done"
               : waits            ? "waits"
               : has_begun(j, i)  ? "begun"
                                  : "ready",
               j->plan.segments[i].cost);
        before = status == ADCGS_OK && found;
    }
    return ADCGS_OK;
}

/** Reports all missing parts in one line, before any part is read. */
static adcgs_status find_missing(const join_job *j, adcgs_error *error)
{
    char names[NAMED * 12 + 8] = "";
    uint32_t n = 0;
    size_t at = 0;
    for (uint32_t i = 0; i < j->plan.cuts.n; i++) {
        char *name;
        ADCGS_TRY(adcgs_enc_part_name(&name, j->base, i, 1, error));
        const int is_there = !access(name, F_OK);
        free(name);
        if (!is_there && n++ < NAMED)
            at += (size_t)snprintf(names + at, sizeof names - at, "%s%u", n > 1 ? ", " : "", i + 1);
    }
    if (!n)
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_IO, "%s: %u of %u parts missing, %s.N.adcgs: %s%s", j->o->plan, n, j->plan.cuts.n, j->base,
                      names, n > NAMED ? ", ..." : "");
}

/* ---- Joining ---- */

static adcgs_status join(const join_job *j, adcgs_error *error)
{
    adcgs_stream stream;
    adcgs_buffer bytes;
    ADCGS_TRY(find_missing(j, error));
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_plan_join(&stream, &j->plan, j->base, j->cpu, j->pool, error);
    if (status == ADCGS_OK)
        status = adcgs_encode_verified(&stream, &bytes, j->cpu, j->pool, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(j->o->output, bytes.data, bytes.size, error);
    if (status == ADCGS_OK)
        adcgs_cli_note(j->cli, "%s: %zu bytes, %u segment%s", j->o->output, bytes.size, stream.n_segments,
                       stream.n_segments > 1 ? "s" : "");
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    return status;
}

/** Refuses an output that is also an input. */
static adcgs_status check_output(const join_job *j, adcgs_error *error)
{
    char *name;
    int same = adcgs_atomic_same(j->o->output, j->o->plan);
    for (uint32_t i = 0; i < j->plan.cuts.n && !same; i++) {
        ADCGS_TRY(adcgs_enc_part_name(&name, j->base, i, 1, error));
        same = adcgs_atomic_same(j->o->output, name);
        free(name);
    }
    return same ? adcgs_fail(error, ADCGS_ERR_USAGE, "%s: is an input: give another output", j->o->output) : ADCGS_OK;
}

static adcgs_status run(join_job *j, int *code, adcgs_error *error)
{
    ADCGS_TRY(adcgs_plan_read(&j->plan, j->o->plan, error));
    ADCGS_TRY(adcgs_plan_check_version(&j->plan, j->o->plan, error));
    ADCGS_TRY(adcgs_plan_base(&j->base, j->o->plan, error));
    ADCGS_TRY(adcgs_cpu_resolve(ADCGS_CPU_AUTO, &j->cpu, error));
    ADCGS_TRY(adcgs_cli_pool(j->cli, &j->pool, j->o->threads, error));
    if (j->o->list)
        return list(j, code, error);
    ADCGS_TRY(check_output(j, error));
    return join(j, error);
}

/* ---- Command line ---- */

static const adcgs_cli program = {
    .program = "adcgs-join",
    .operands = "PLAN.json",
    .summary = "Check the parts of a plan and join them to one stream.",
    .details = "adcgs-enc SCENE --plan PLAN.json makes the plan, adcgs-enc SCENE --plan PLAN.json --segment 1,\n"
               "2, ... the parts. Parts are not moved.",
    .min_operands = 1,
    .max_operands = 1,
};

/** Returns -1 to continue, else the exit code. */
static int parse(adcgs_cli *cli, join_options *o, int argc, char **argv)
{
    static const adcgs_option_rule rules[] = {{"output,list", ADCGS_OPTION_APART, NULL}};
    const adcgs_option options[] = {
        {"output", 'o', ADCGS_OPTION_FILE, &o->output, 0, 0, "FILE", "stream to write", NULL, NULL},
        {"list", 0, ADCGS_OPTION_FLAG, &o->list, 0, 0, NULL,
         "print a line for each segment instead: its number, the number\n"
         "of the segment it is trained from (0: none), its state (done,\n"
         "begun, ready, waits for the other, or bad), and its cost in\nseconds",
         NULL, NULL},
        {"threads", 'T', ADCGS_OPTION_INT, &o->threads, 0, 256, "N", "threads (default: one per CPU)", NULL, NULL},
        {.letter = 't', .kind = ADCGS_OPTION_FORMER, .value = "threads"},
    };
    int first;
    cli->options = options;
    cli->n_options = ADCGS_COUNTOF(options);
    cli->rules = rules;
    cli->n_rules = ADCGS_COUNTOF(rules);
    cli->quiet = &o->quiet;
    const int code = adcgs_cli_parse(cli, argc, argv, &first);
    cli->n_options = 0; /* options is local to this function */
    if (code >= 0)
        return code;
    o->plan = argv[first];
    if (!o->output && !o->list)
        return adcgs_cli_error(cli, ADCGS_ERR_USAGE, "no output: give -o FILE");
    return -1;
}

int main(int argc, char **argv)
{
    join_options o = {.plan = NULL};
    adcgs_cli cli = program;
    int code = parse(&cli, &o, argc, argv);
    if (code >= 0)
        return code;
    adcgs_error error = {ADCGS_OK, ""};
    join_job job = {.cli = &cli, .o = &o};
    code = 0;
    const adcgs_status status = run(&job, &code, &error);
    adcgs_plan_clear(&job.plan);
    adcgs_pool_free(&job.pool);
    free(job.base);
    if (status != ADCGS_OK)
        return adcgs_cli_fail(&cli, &error);
    return adcgs_cli_leave(&cli, code);
}
