/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Temporary files of a run of several segments. */
#include "config.h"

#include "session/enc_parts.h"

#include "model/model_priv.h"
#include "stream/input.h"
#include "system/atomic.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#define AWAIT_NAP 100000000L /* nanoseconds between looks; chosen by hand, not measured */
#define AWAIT_NAPS 900       /* looks, a minute and a half: NFS refreshes its cache after one */

adcgs_status adcgs_enc_part_name(char **name, const char *base, uint32_t part, int is_stream, adcgs_error *error)
{
    const size_t n = strlen(base) + 32;
    *name = malloc(n);
    if (!*name)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
    snprintf(*name, n, "%s.%u%s", base, part + 1, is_stream ? ".adcgs" : "");
    return ADCGS_OK;
}

adcgs_status adcgs_enc_claim_name(char **name, const char *state, adcgs_error *error)
{
    const size_t n = strlen(state) + 16;
    *name = malloc(n);
    if (!*name)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory");
    snprintf(*name, n, "%s.claim", state);
    return ADCGS_OK;
}

void adcgs_enc_part_remove(const char *base, uint32_t part, int is_stream)
{
    char *name;
    adcgs_error ignored;
    if (adcgs_enc_part_name(&name, base, part, is_stream, &ignored) == ADCGS_OK)
        unlink(name);
    free(name);
}

void adcgs_enc_parts_remove(const char *base, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        adcgs_enc_part_remove(base, i, 1);
}

adcgs_status adcgs_enc_part_save(const char *base, const adcgs_cuts *cuts, uint32_t part, const adcgs_trainer *t,
                                 const adcgs_encode_note *notes, uint32_t n_notes, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_stream stream;
    adcgs_buffer bytes;
    char *name = NULL;
    adcgs_buffer_init(&bytes);
    adcgs_status status = adcgs_encode_begin(&stream, t->scene->whole ? t->scene->whole : t->scene, cuts, notes, n_notes, error);
    if (status == ADCGS_OK)
        status = adcgs_encode_segment(&stream, t, cuts, part, error);
    if (status == ADCGS_OK)
        status = adcgs_encode_verified(&stream, &bytes, t->cpu, pool, error);
    if (status == ADCGS_OK)
        status = adcgs_enc_part_name(&name, base, part, 1, error);
    if (status == ADCGS_OK)
        status = adcgs_atomic_save(name, bytes.data, bytes.size, error);
    if (status == ADCGS_OK)
        adcgs_enc_part_remove(base, part, 0);
    free(name);
    adcgs_buffer_clear(&bytes);
    adcgs_stream_clear(&stream, NULL);
    return status;
}

adcgs_status adcgs_enc_part_load(adcgs_stream *stream, const char *name, adcgs_cpu_level cpu, adcgs_pool *pool, int *found,
                                 adcgs_error *error)
{
    const adcgs_read_options options = {.cpu = cpu, .pool = pool, .strict_end = 1};
    adcgs_error why;
    FILE *file = fopen(name, "rb");
    *found = file != NULL;
    if (!file)
        return errno == ENOENT ? ADCGS_OK : adcgs_fail(error, ADCGS_ERR_IO, "%s: %s", name, strerror(errno));
    const adcgs_status status = adcgs_stream_read(stream, adcgs_file_read, file, &options, NULL, NULL, &why);
    fclose(file);
    return status == ADCGS_OK ? status : adcgs_fail(error, status, "%s: %.200s", name, why.text);
}

/** True for notes that are unknown before a run ends. */
static int follows_from_run(const char *key)
{
    return !strcmp(key, "lambda") || !strcmp(key, "decisions");
}

/** Names a value that differs from the present one; NULL: none. */
static const char *difference(const adcgs_stream *now, const adcgs_stream *then)
{
    for (int a = 0; a < 3; a++)
        if (now->scene_origin[a] != then->scene_origin[a])
            return "scene";
    if (now->scene_scale != then->scene_scale || then->n_segments != 1)
        return "scene";
    if (now->timebase_num != then->timebase_num || now->timebase_den != then->timebase_den ||
        now->start_ticks != then->start_ticks || now->duration_ticks != then->duration_ticks ||
        now->segments[0].reach != then->segments[0].reach)
        return "time";
    if (now->n_meta != then->n_meta)
        return "settings";
    for (uint32_t i = 0; i < now->n_meta; i++)
        if (strcmp(now->meta[i].key, then->meta[i].key) ||
            (!follows_from_run(now->meta[i].key) && strcmp(now->meta[i].value, then->meta[i].value)))
            return now->meta[i].key;
    return NULL;
}

adcgs_status adcgs_enc_part_check(const char *base, const adcgs_scene *scene, const adcgs_cuts *cuts, uint32_t part,
                                  const adcgs_encode_note *notes, uint32_t n_notes, adcgs_cpu_level cpu, adcgs_pool *pool,
                                  int *found, adcgs_error *error)
{
    adcgs_stream now, then;
    adcgs_model none = {.n = 0};
    char *name;
    *found = 0;
    ADCGS_TRY(adcgs_enc_part_name(&name, base, part, 1, error));
    adcgs_stream_init(&then);
    adcgs_status status = adcgs_encode_begin(&now, scene, cuts, notes, n_notes, error);
    if (status == ADCGS_OK)
        adcgs_encode_place(&now, cuts, part, &none); /* for its time only */
    if (status == ADCGS_OK)
        status = adcgs_enc_part_load(&then, name, cpu, pool, found, error);
    const char *const what = status == ADCGS_OK && *found ? difference(&now, &then) : NULL;
    if (what)
        status = adcgs_fail(error, ADCGS_ERR_DATA,
                            "%s: belongs to another run (different %s): remove it, or name another "
                            "output",
                            name, what);
    adcgs_stream_clear(&now, NULL);
    adcgs_stream_clear(&then, NULL);
    free(name);
    return status;
}

void adcgs_enc_part_await(const char *base, uint32_t part)
{
    const struct timespec nap = {0, AWAIT_NAP};
    adcgs_error ignored;
    char *name;
    if (adcgs_enc_part_name(&name, base, part, 1, &ignored) != ADCGS_OK)
        return;
    for (int i = 0; i < AWAIT_NAPS && access(name, F_OK) && errno == ENOENT; i++)
        nanosleep(&nap, NULL);
    free(name);
}

/** Moves the notes of a part to the stream. */
static void take_notes(adcgs_stream *to, adcgs_stream *from)
{
    to->meta = from->meta;
    to->n_meta = from->n_meta;
    from->meta = NULL;
    from->n_meta = 0;
}

/** Reads a part's stream, which has to be present; the caller clears it. */
static adcgs_status load_part(adcgs_stream *one, const char *base, uint32_t part, adcgs_cpu_level cpu, adcgs_pool *pool,
                              adcgs_error *error)
{
    char *name;
    int found;
    adcgs_stream_init(one);
    ADCGS_TRY(adcgs_enc_part_name(&name, base, part, 1, error));
    adcgs_status status = adcgs_enc_part_load(one, name, cpu, pool, &found, error);
    if (status == ADCGS_OK && !found)
        status = adcgs_fail(error, ADCGS_ERR_IO, "%s: the file has been removed", name);
    free(name);
    return status;
}

adcgs_status adcgs_enc_part_model(adcgs_model *model, const char *base, uint32_t part, adcgs_cpu_level cpu, adcgs_pool *pool,
                                  adcgs_error *error)
{
    adcgs_stream one;
    const adcgs_status status = load_part(&one, base, part, cpu, pool, error);
    memset(model, 0, sizeof *model);
    if (status == ADCGS_OK) {
        *model = one.segments[0];
        memset(&one.segments[0], 0, sizeof *model);
    }
    adcgs_stream_clear(&one, NULL);
    return status;
}

static adcgs_status join_one(adcgs_stream *stream, const char *base, const adcgs_cuts *cuts, uint32_t part, int follows,
                             adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_stream one;
    adcgs_status status = load_part(&one, base, part, cpu, pool, error);
    if (status == ADCGS_OK && follows)
        status = adcgs_encode_predict(&one.segments[0], &stream->segments[part - 1], error);
    if (status == ADCGS_OK) {
        adcgs_encode_place(stream, cuts, part, &one.segments[0]);
        if (part + 1 == cuts->n)
            take_notes(stream, &one);
    }
    adcgs_stream_clear(&one, NULL);
    return status;
}

adcgs_status adcgs_enc_parts_join(adcgs_stream *stream, const char *base, const adcgs_scene *scene, const adcgs_cuts *cuts,
                                  const uint8_t *follows, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    ADCGS_TRY(adcgs_encode_begin(stream, scene, cuts, NULL, 0, error));
    for (uint32_t i = 0; i < cuts->n; i++)
        ADCGS_TRY(join_one(stream, base, cuts, i, follows[i], cpu, pool, error));
    return ADCGS_OK;
}
