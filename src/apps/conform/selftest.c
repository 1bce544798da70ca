/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Tests that the conformance check notices damaged expectations, damaged streams, and programs that lie, crash or hang. */
#include "apps/conform/conform.h"

#include <stdlib.h>

typedef struct selftest {
    int *runs, *faults;
    const uint8_t *data;
    size_t bytes;
} selftest;

/* One damage: the check has to fail. */
static void must_notice(const selftest *t, const adcgs_vector *damaged, const uint8_t *data, size_t bytes, const char *damage)
{
    const adcgs_trial trial = {.cpu = ADCGS_CPU_AUTO, .threads = 1};
    char what[ADCGS_WHAT];
    ++*t->runs;
    if (adcgs_vector_try(damaged, data, bytes, &trial, what) == ADCGS_OUTCOME_WRONG)
        return;
    ++*t->faults;
    printf("%-40s not noticed: %s\n", damaged->id, damage);
}

static void change_hex(char hex[ADCGS_HEX])
{
    hex[7] = hex[7] == '0' ? '1' : '0';
}

static void damage_results(const selftest *t, const adcgs_vector *vector, adcgs_vector *v)
{
    v->truncated = !v->truncated;
    must_notice(t, v, t->data, t->bytes, "truncated or not");
    *v = *vector;
    v->elements++;
    must_notice(t, v, t->data, t->bytes, "number of elements");
    *v = *vector;
    change_hex(v->trace);
    must_notice(t, v, t->data, t->bytes, "digest of the trace");
    *v = *vector;
    v->n_models++;
    must_notice(t, v, t->data, t->bytes, "number of models");
    for (int i = 0; i < vector->n_models; i++) {
        *v = *vector;
        change_hex(v->models[i]);
        must_notice(t, v, t->data, t->bytes, "digest of a model");
    }
    for (int i = 0; i < vector->n_splats; i++) {
        *v = *vector;
        change_hex(v->splats[i].md5);
        must_notice(t, v, t->data, t->bytes, "digest of splats");
    }
    for (int i = 0; i < vector->n_fewer; i++) {
        *v = *vector;
        change_hex(v->fewer[i].models[0]);
        must_notice(t, v, t->data, t->bytes, "digest of a model with fewer layers");
        *v = *vector;
        change_hex(v->fewer[i].splats[0].md5);
        must_notice(t, v, t->data, t->bytes, "digest of splats with fewer layers");
    }
    for (int i = 0; i < vector->n_frames; i++) {
        *v = *vector;
        change_hex(v->frames[i].md5);
        must_notice(t, v, t->data, t->bytes, "digest of a frame");
    }
}

/* Damages a stream and corrects the digest of its file, so that decoding has to notice. */
static void damage_stream(const selftest *t, const adcgs_vector *vector, adcgs_vector *v)
{
    uint8_t *const copy = malloc(t->bytes + 1);
    if (!copy)
        return;
    memcpy(copy, t->data, t->bytes);
    copy[t->bytes / 2] ^= 4;
    *v = *vector;
    adcgs_hex_of(copy, t->bytes, v->md5);
    must_notice(t, v, copy, t->bytes, "a bit in the middle of the file");
    copy[t->bytes / 2] ^= 4;
    adcgs_hex_of(copy, t->bytes / 2, v->md5);
    must_notice(t, v, copy, t->bytes / 2, "one half of the file");
    free(copy);
}

void adcgs_selftest_vector(const adcgs_manifest *manifest, const adcgs_vector *vector, int *runs, int *faults)
{
    uint8_t *data = NULL;
    selftest t = {.runs = runs, .faults = faults};
    adcgs_error error;
    adcgs_vector *const v = malloc(sizeof *v);
    if (!v || adcgs_vector_load(manifest, vector, &data, &t.bytes, &error) != ADCGS_OK) {
        printf("%-40s %s\n", vector->id, v ? error.text : "out of memory");
        ++*faults;
        free(v);
        return;
    }
    t.data = data;
    *v = *vector;
    change_hex(v->md5);
    must_notice(&t, v, data, t.bytes, "MD5 of the file");
    *v = *vector;
    v->status = vector->status == ADCGS_ERR_DATA ? ADCGS_ERR_LIMIT : ADCGS_ERR_DATA;
    must_notice(&t, v, data, t.bytes, "status");
    *v = *vector;
    if (vector->status != ADCGS_OK) {
        v->status = ADCGS_OK;
        must_notice(&t, v, data, t.bytes, "verdict");
    } else {
        damage_results(&t, vector, v);
        damage_stream(&t, vector, v);
    }
    free(data);
    free(v);
}

/* ---- Programs ---- */

static void must_be(const adcgs_manifest *manifest, const adcgs_vector *vector, const char *command, adcgs_outcome expected,
                    int *runs, int *faults)
{
    const adcgs_program program = {.command = command, .point = 3, .timeout = 1};
    char what[ADCGS_WHAT] = "";
    const adcgs_outcome outcome = adcgs_program_try(&program, manifest, vector, what);
    ++*runs;
    if (outcome == expected)
        return;
    ++*faults;
    printf("%-40s \"%s\" is %s, expected %s\n", vector->id, command, adcgs_outcome_name(outcome), adcgs_outcome_name(expected));
}

void adcgs_selftest_program(const adcgs_manifest *manifest, int *runs, int *faults)
{
    static const struct {
        const char *command;
        adcgs_outcome good, refused; /* for a good vector, and for one to be refused as data */
    } programs[] = {
        {"kill -SEGV $$", ADCGS_OUTCOME_CRASHED, ADCGS_OUTCOME_CRASHED},
        {"echo fault data; kill -ABRT $$", ADCGS_OUTCOME_CRASHED, ADCGS_OUTCOME_CRASHED},
        {"(kill -SEGV $(exec sh -c 'echo $PPID')); exit 139", ADCGS_OUTCOME_CRASHED, ADCGS_OUTCOME_CRASHED},
        {"sleep 30", ADCGS_OUTCOME_TIMEOUT, ADCGS_OUTCOME_TIMEOUT},
        {"echo fault data; sleep 30; exit 4", ADCGS_OUTCOME_TIMEOUT, ADCGS_OUTCOME_TIMEOUT},
        {"exec >&-; sleep 30", ADCGS_OUTCOME_TIMEOUT, ADCGS_OUTCOME_TIMEOUT},
        {"exit 4", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"exit 0", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"echo fault data; exit 4", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_OK},
        {"echo fault data >{out}; exit 4", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_OK},
        {"echo fault data; exit 5", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"echo fault data", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"echo fault limit; exit 4", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"echo fault data; echo fault data; exit 4", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"cat {request}", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"head -c 3000000 /dev/zero", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
        {"/nonexistent/decoder {in} {request}", ADCGS_OUTCOME_WRONG, ADCGS_OUTCOME_WRONG},
    };
    const adcgs_vector *good = NULL, *refused = NULL;
    for (int i = 0; i < manifest->n; i++) {
        good = manifest->vectors[i].status == ADCGS_OK ? &manifest->vectors[i] : good;
        refused = manifest->vectors[i].status == ADCGS_ERR_DATA ? &manifest->vectors[i] : refused;
    }
    for (size_t i = 0; good && refused && i < ADCGS_COUNTOF(programs); i++) {
        must_be(manifest, good, programs[i].command, programs[i].good, runs, faults);
        must_be(manifest, refused, programs[i].command, programs[i].refused, runs, faults);
    }
}
