/* SPDX-License-Identifier: BSD-2-Clause */
/** \file adcgs-conform: every vector of a manifest at every CPU level and several thread counts. */
#include "base/cpu.h"
#include "tools/cli.h"
#include "tools/conform.h"

#include <stdlib.h>

static const int thread_counts[] = {1, 2, 7};

typedef struct tally {
    int runs, faults;
} tally;

/* All levels and thread counts; returns nonzero if every run is as expected. */
static int try_everywhere(const adcgs_vector *vector, const uint8_t *data, size_t bytes, int *runs, char *what, size_t size)
{
    char why[320];
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++)
        for (size_t i = 0; i < ADCGS_COUNTOF(thread_counts); i++) {
            ++*runs;
            if (!adcgs_vector_try(vector, data, bytes, (adcgs_cpu_level)level, thread_counts[i], why, sizeof why)) {
                snprintf(what, size, "%s, %d threads: %s", adcgs_cpu_name((adcgs_cpu_level)level), thread_counts[i], why);
                return 0;
            }
        }
    return 1;
}

static void check_vector(const adcgs_manifest *manifest, const adcgs_vector *vector, tally *t)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    int runs = 0, good = 0;
    char what[512];
    adcgs_error error;
    if (adcgs_vector_load(manifest, vector, &data, &bytes, &error) != ADCGS_OK)
        snprintf(what, sizeof what, "%s", error.text);
    else
        good = try_everywhere(vector, data, bytes, &runs, what, sizeof what);
    free(data);
    printf("%-32s %-11s %2d frames %3d runs  %s\n", vector->file, vector->status == ADCGS_OK ? "good" : "bad", vector->n_frames,
           runs, good ? "ok" : what);
    t->runs += runs;
    t->faults += !good;
}

/* One damaged expectation or stream: the check has to fail. */
static void must_notice(const adcgs_vector *damaged, const uint8_t *data, size_t bytes, const char *damage, tally *t)
{
    char what[320];
    t->runs++;
    if (!adcgs_vector_try(damaged, data, bytes, ADCGS_CPU_AUTO, 1, what, sizeof what))
        return;
    t->faults++;
    printf("%-32s not noticed: %s\n", damaged->file, damage);
}

static void change_hex(char hex[ADCGS_HEX])
{
    hex[7] = hex[7] == '0' ? '1' : '0';
}

static void damage_expectations(const adcgs_vector *vector, const uint8_t *data, size_t bytes, tally *t)
{
    adcgs_vector v = *vector;
    change_hex(v.md5);
    must_notice(&v, data, bytes, "MD5 of the file", t);
    v = *vector;
    v.status = vector->status == ADCGS_ERR_DATA ? ADCGS_ERR_LIMIT : ADCGS_ERR_DATA;
    must_notice(&v, data, bytes, "status", t);
    if (vector->status != ADCGS_OK) {
        v.status = ADCGS_OK;
        must_notice(&v, data, bytes, "verdict", t);
        return;
    }
    v = *vector;
    v.n_models++;
    must_notice(&v, data, bytes, "number of models", t);
    for (int i = 0; i < vector->n_models; i++) {
        v = *vector;
        change_hex(v.models[i]);
        must_notice(&v, data, bytes, "digest of a model", t);
    }
    for (int i = 0; i < vector->n_frames; i++) {
        v = *vector;
        change_hex(v.frames[i].md5);
        must_notice(&v, data, bytes, "digest of a frame", t);
    }
}

static void self_test(const adcgs_manifest *manifest, const adcgs_vector *vector, tally *t)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    adcgs_error error;
    if (adcgs_vector_load(manifest, vector, &data, &bytes, &error) != ADCGS_OK) {
        printf("%-32s %s\n", vector->file, error.text);
        t->faults++;
        return;
    }
    damage_expectations(vector, data, bytes, t);
    if (bytes > 0) {
        data[bytes / 2] ^= 4;
        must_notice(vector, data, bytes, "a bit in the middle of the file", t);
        data[bytes / 2] ^= 4;
        must_notice(vector, data, bytes - 1, "last byte cut off", t);
    }
    free(data);
}

int main(int argc, char **argv)
{
    int self = 0, first = 0;
    const adcgs_option options[] = {
        {.name = "self-test", .kind = ADCGS_OPTION_FLAG, .target = &self,
         .help = "damage each expectation and each stream in memory, one at a time, and require\nthat the check notices"},
    };
    const adcgs_cli cli = {
        .program = "adcgs-conform",
        .operands = "[MANIFEST]",
        .summary = "Check this decoder against conformance vectors.",
        .details = "MANIFEST is conformance/manifest.json unless given. Each vector is decoded at every CPU level that\n"
                   "this machine has, with 1, 2 and 7 threads.",
        .options = options,
        .n_options = ADCGS_COUNTOF(options),
        .max_operands = 1};
    const int leave = adcgs_cli_parse(&cli, argc, argv, &first);
    if (leave >= 0)
        return leave;
    adcgs_manifest manifest;
    adcgs_error error;
    tally t = {0, 0};
    if (adcgs_manifest_read(&manifest, first < argc ? argv[first] : "conformance/manifest.json", &error) != ADCGS_OK)
        return adcgs_cli_fail(&cli, &error);
    for (int i = 0; i < manifest.n; i++) {
        if (self)
            self_test(&manifest, &manifest.vectors[i], &t);
        else
            check_vector(&manifest, &manifest.vectors[i], &t);
    }
    printf(self ? "%d vectors, %d damages, %d not noticed\n" : "%d vectors, %d runs, %d failed\n", manifest.n, t.runs, t.faults);
    adcgs_manifest_clear(&manifest);
    return t.faults ? 1 : 0;
}
