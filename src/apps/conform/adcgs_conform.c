/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-conform: tries every vector of a manifest on this library, in every way that it can run, or on any program. */
#include "config.h"

#include "apps/conform/conform.h"
#include "base/cpu_detect.h"
#include "cli/cli.h"
#include "system/text.h"

#include <fnmatch.h>
#include <stdlib.h>
#include <unistd.h>

#define ID_WIDTH 36 /* columns of the table; chosen by hand, not measured */
#define MANIFEST_HERE "conformance/manifest.json"
#define MANIFEST_INSTALLED CONFORMANCE_DIRECTORY "/manifest.json"

/* Each vector is decoded by so many threads; chosen by hand, not measured. */
static const int thread_counts[] = {1, 2, 7};
/* Its input comes in pieces of 1 to so many bytes, 0: in the requested sizes; chosen by hand, not measured. */
static const int steps[] = {0, 7};

typedef struct settings {
    const char *filter, *junit;
    int list, selftest, point;
    adcgs_program program;
} settings;

typedef struct tally {
    int vectors, runs, faults;
    int outcome[4];
    adcgs_junit junit;
} tally;

/* Tries all CPU levels, thread counts and ways of input, until one fails. */
static adcgs_outcome try_everywhere(const adcgs_vector *vector, const uint8_t *data, size_t bytes, int *runs,
                                    char what[ADCGS_WHAT])
{
    char why[ADCGS_WHAT];
    adcgs_trial t = {.cpu = ADCGS_CPU_SCALAR};
    for (; t.cpu <= adcgs_cpu_best(); t.cpu = (adcgs_cpu_level)(t.cpu + 1))
        for (size_t i = 0; i < ADCGS_COUNTOF(thread_counts) * ADCGS_COUNTOF(steps); i++) {
            t.threads = thread_counts[i / ADCGS_COUNTOF(steps)];
            t.step = steps[i % ADCGS_COUNTOF(steps)];
            ++*runs;
            if (adcgs_vector_try(vector, data, bytes, &t, why) == ADCGS_OUTCOME_OK)
                continue;
            snprintf(what, ADCGS_WHAT, "%s, %d thread%s, input %s: %.320s", adcgs_cpu_name(t.cpu), t.threads,
                     adcgs_s((uint64_t)t.threads), t.step ? "in pieces" : "whole", why);
            return ADCGS_OUTCOME_WRONG;
        }
    return ADCGS_OUTCOME_OK;
}

static void check_vector(const settings *s, const adcgs_manifest *manifest, const adcgs_vector *vector, tally *t)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    int runs = 0;
    char what[ADCGS_WHAT] = "";
    adcgs_error error;
    adcgs_outcome outcome = ADCGS_OUTCOME_WRONG;
    const double start = adcgs_seconds();
    if (s->program.command) {
        runs = 1;
        outcome = adcgs_program_try(&s->program, manifest, vector, what);
    } else if (adcgs_vector_load(manifest, vector, &data, &bytes, &error) == ADCGS_OK)
        outcome = try_everywhere(vector, data, bytes, &runs, what);
    else
        snprintf(what, sizeof what, "%s", error.text);
    const double seconds = adcgs_seconds() - start;
    free(data);
    const char *const kind = vector->status == ADCGS_OK ? "good" : adcgs_vector_class_name(vector->status);
    adcgs_text_column(stdout, vector->id, ID_WIDTH);
    printf(" %-11s %2d frames %3d runs %6.0f ms  %s%s", kind, vector->n_frames, runs, 1000 * seconds, adcgs_outcome_name(outcome),
           outcome == ADCGS_OUTCOME_OK ? "" : ": ");
    adcgs_text_show(stdout, what); /* it may quote a program's answers */
    printf("\n");
    t->runs += runs;
    t->faults += outcome != ADCGS_OUTCOME_OK;
    t->outcome[outcome]++;
    adcgs_junit_add(&t->junit, vector, outcome, seconds, what);
}

static void use_vector(const settings *s, const adcgs_manifest *manifest, const adcgs_vector *vector, tally *t)
{
    if (s->filter && fnmatch(s->filter, vector->id, 0) != 0)
        return;
    t->vectors++;
    if (s->list) {
        adcgs_text_column(stdout, vector->id, ID_WIDTH);
        printf(" ");
        adcgs_text_show(stdout, vector->title);
        printf("\n");
    } else if (s->selftest)
        adcgs_selftest_vector(manifest, vector, &t->runs, &t->faults);
    else
        check_vector(s, manifest, vector, t);
}

static void use_manifest(const settings *s, const adcgs_manifest *manifest, tally *t)
{
    for (int i = 0; i < manifest->n; i++)
        use_vector(s, manifest, &manifest->vectors[i], t);
    if (s->selftest)
        adcgs_selftest_program(manifest, &t->runs, &t->faults);
    if (s->list)
        return;
    if (s->selftest)
        printf("%d vectors, %d damages, %d not noticed\n", t->vectors, t->runs, t->faults);
    else
        printf("%d vectors, %d runs, %d ok, %d wrong, %d crashed, %d timed out\n", t->vectors, t->runs,
               t->outcome[ADCGS_OUTCOME_OK], t->outcome[ADCGS_OUTCOME_WRONG], t->outcome[ADCGS_OUTCOME_CRASHED],
               t->outcome[ADCGS_OUTCOME_TIMEOUT]);
}

static int run(const adcgs_cli *cli, settings *s, const char *path)
{
    adcgs_manifest manifest;
    adcgs_error error = {ADCGS_OK, ""};
    tally t = {0};
    s->program.point = s->point;
    if (adcgs_manifest_read(&manifest, path, &error) != ADCGS_OK)
        return adcgs_cli_fail(cli, &error);
    adcgs_status status = adcgs_junit_open(&t.junit, s->junit, &error);
    if (status == ADCGS_OK) {
        use_manifest(s, &manifest, &t);
        status = adcgs_junit_close(&t.junit, &error);
    }
    adcgs_manifest_clear(&manifest);
    if (status == ADCGS_OK && t.vectors == 0)
        status = adcgs_fail(&error, ADCGS_ERR_USAGE, "no vector matches %s", s->filter);
    if (status == ADCGS_OK)
        status = adcgs_cli_flush(&error);
    return status != ADCGS_OK ? adcgs_cli_fail(cli, &error) : t.faults ? 1 : 0;
}

/** Returns the first manifest that exists, or NULL. */
static const char *find_manifest(void)
{
    static const char *const places[] = {MANIFEST_HERE, MANIFEST_INSTALLED};
    for (size_t i = 0; i < ADCGS_COUNTOF(places); i++)
        if (!access(places[i], F_OK))
            return places[i];
    return NULL;
}

/** Fills the table of options, with targets in s. */
static void list_options(adcgs_option_table *out, settings *s)
{
    static const char *const points[] = {"P", "M", "S", "R", NULL};
    const adcgs_option table[] = {
        {.name = "decoder",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->program.command,
         .value = "COMMAND",
         .help = "program to check instead of the library; the shell runs it, with\n{in} and {request} replaced by files"},
        {.name = "point",
         .kind = ADCGS_OPTION_CHOICE,
         .target = &s->point,
         .choices = points,
         .value = "POINT",
         .help = "conformance point that the program claims: P, M, S or R\n(default R)"},
        {.name = "layers",
         .kind = ADCGS_OPTION_FLAG,
         .target = &s->program.layers,
         .help = "the program claims that it can leave out layers: check that, too"},
        {.name = "timeout",
         .kind = ADCGS_OPTION_INT,
         .target = &s->program.timeout,
         .min = 1,
         .max = 3600,
         .value = "SECONDS",
         .help = "time limit of the program for a vector, seconds (default 20)"},
        {.name = "filter",
         .kind = ADCGS_OPTION_STRING,
         .target = &s->filter,
         .value = "PATTERN",
         .help = "names of the vectors to check, a pattern such as 'bad-geom-*'\n(default: all)"},
        {.name = "list", .kind = ADCGS_OPTION_FLAG, .target = &s->list, .help = "print names and titles without checking"},
        {.name = "junit",
         .kind = ADCGS_OPTION_FILE,
         .target = &s->junit,
         .value = "FILE",
         .help = "results as JUnit XML (default: none)"},
        {.name = "self-test",
         .kind = ADCGS_OPTION_FLAG,
         .target = &s->selftest,
         .help = "damage each expectation and each stream in memory, one at a time, and run\n"
                 "programs that lie, crash and hang; require that the check notices"},
    };
    adcgs_options_add(out, table, ADCGS_COUNTOF(table));
}

int main(int argc, char **argv)
{
    settings s = {.point = 3, .program = {.timeout = 20}};
    adcgs_option_table options = {.n = 0};
    list_options(&options, &s);
    int first = 0;
    const adcgs_cli cli =
        {.program = "adcgs-conform",
         .operands = "[MANIFEST]",
         .summary = "Check a decoder against conformance vectors.",
         .details = "The default MANIFEST is conformance/manifest.json, here or else as installed in\n" CONFORMANCE_DIRECTORY
                    ".\nWithout --decoder, the library is checked at every CPU level of this machine,\n"
                    "with 1, 2 and 7 threads, with the input as a whole and in pieces of a few bytes.",
         .options = options.rows,
         .n_options = options.n,
         .max_operands = 1};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    const char *manifest = first < argc ? argv[first] : find_manifest();
    if (!manifest)
        return adcgs_cli_error(&cli, ADCGS_ERR_IO,
                               "no manifest: neither " MANIFEST_HERE " nor " MANIFEST_INSTALLED "; give MANIFEST");
    return run(&cli, &s, manifest);
}
