/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The parts of a plan. */
#include "config.h"

#include "session/plan_parts.h"

#include "base/digest.h"
#include "encode/encode.h"
#include "model/model_priv.h"
#include "session/enc_parts.h"

#include <math.h>
#include <stdlib.h>

adcgs_status adcgs_plan_base(char **base, const char *path, adcgs_error *error)
{
    const size_t n = strlen(path);
    *base = strdup(path);
    if (!*base)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", path);
    if (n > 5 && !strcmp(path + n - 5, ".json"))
        (*base)[n - 5] = 0;
    return ADCGS_OK;
}

adcgs_status adcgs_plan_check_version(const adcgs_plan *plan, const char *path, adcgs_error *error)
{
    if (!strcmp(plan->encoder, "adcgs-enc " PACKAGE_VERSION))
        return ADCGS_OK;
    return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: by %s, but this is adcgs-enc %s, which may train differently", path,
                      plan->encoder, PACKAGE_VERSION);
}

/* ---- One part ---- */

static const char *note_of(const adcgs_stream *s, const char *key)
{
    for (uint32_t i = 0; i < s->n_meta; i++)
        if (!strcmp(s->meta[i].key, key))
            return s->meta[i].value;
    return "";
}

static int is_same_time(double a, double b, const adcgs_plan *plan)
{
    return fabs(a - b) * plan->timebase_den < 0.5 * plan->timebase_num; /* within half a tick */
}

/** Names a value that differs from the plan's; NULL: none. */
static const char *difference(const adcgs_stream *one, const adcgs_plan *plan, uint32_t part)
{
    if (one->n_segments != 1)
        return "number of segments";
    if (memcmp(one->scene_origin, plan->origin, sizeof plan->origin) || one->scene_scale != plan->scale)
        return "scene";
    if (one->timebase_num != plan->timebase_num || one->timebase_den != plan->timebase_den ||
        !is_same_time(one->segments[0].time_start, plan->cuts.at[part], plan) ||
        !is_same_time(one->segments[0].time_end, plan->cuts.at[part + 1], plan) ||
        !is_same_time(one->segments[0].reach, plan->cuts.reach[part], plan))
        return "time";
    const int follows = *note_of(one, ADCGS_NOTE_FOLLOWS) != 0;
    return follows != plan->segments[part].follows ? "predecessor" : NULL;
}

static adcgs_status check(const adcgs_stream *one, const adcgs_plan *plan, uint32_t part, const char *name, adcgs_error *error)
{
    const char *const by = note_of(one, "encoder"), *const of = note_of(one, ADCGS_NOTE_PLAN);
    if (!*of)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: a stream, but not a part of a plan", name);
    if (strcmp(by, plan->encoder))
        return adcgs_fail(error, ADCGS_ERR_UNSUPPORTED, "%s: by %.64s, but the plan is by %s", name, by, plan->encoder);
    if (strcmp(of, plan->digest))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: belongs to another plan", name);
    const char *const what = difference(one, plan, part);
    return what ? adcgs_fail(error, ADCGS_ERR_DATA, "%s: its %s is not that of segment %u of the plan", name, what, part + 1)
                : ADCGS_OK;
}

adcgs_status adcgs_plan_part_load(adcgs_stream *one, const adcgs_plan *plan, const char *base, uint32_t part, adcgs_cpu_level cpu,
                                  adcgs_pool *pool, int *found, adcgs_error *error)
{
    char *name;
    adcgs_stream_init(one);
    *found = 0;
    ADCGS_TRY(adcgs_enc_part_name(&name, base, part, 1, error));
    adcgs_status status = adcgs_enc_part_load(one, name, cpu, pool, found, error);
    if (status == ADCGS_OK && *found)
        status = check(one, plan, part, name, error);
    free(name);
    return status;
}

/** Reads a part that has to be present. */
static adcgs_status need_part(adcgs_stream *one, const adcgs_plan *plan, const char *base, uint32_t part, adcgs_cpu_level cpu,
                              adcgs_pool *pool, adcgs_error *error)
{
    int found;
    ADCGS_TRY(adcgs_plan_part_load(one, plan, base, part, cpu, pool, &found, error));
    return found ? ADCGS_OK
                 : adcgs_fail(error, ADCGS_ERR_IO, "%s.%u.adcgs: missing: train segment %u first", base, part + 1, part + 1);
}

adcgs_status adcgs_plan_part_model(adcgs_model *model, const adcgs_plan *plan, const char *base, uint32_t part,
                                   adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_stream one;
    const adcgs_status status = need_part(&one, plan, base, part, cpu, pool, error);
    memset(model, 0, sizeof *model);
    if (status == ADCGS_OK) {
        *model = one.segments[0];
        memset(&one.segments[0], 0, sizeof *model);
    }
    adcgs_stream_clear(&one, NULL);
    return status;
}

/* ---- All parts ---- */

/** Sets everything except segments and notes. Values that the source owns are moved. */
static adcgs_status begin(adcgs_stream *to, adcgs_stream *from, uint32_t segments, adcgs_error *error)
{
    to->level = 0;
    to->timebase_num = from->timebase_num;
    to->timebase_den = from->timebase_den;
    to->rate_num = from->rate_num;
    to->rate_den = from->rate_den;
    memcpy(to->scene_origin, from->scene_origin, sizeof to->scene_origin);
    to->scene_scale = from->scene_scale;
    memcpy(to->background, from->background, sizeof to->background);
    to->screen_filter = from->screen_filter;
    to->colour_space = from->colour_space;
    to->axes = from->axes;
    to->units = from->units;
    to->cameras = from->cameras;
    to->n_cameras = from->n_cameras;
    from->cameras = NULL;
    from->n_cameras = 0;
    to->segments = adcgs_alloc(NULL, segments, sizeof *to->segments, error);
    return to->segments ? ADCGS_OK : adcgs_alloc_status(error);
}

/** Takes the notes of the last part, except the trailing ones that identify its plan. */
static void take_notes(adcgs_stream *to, adcgs_stream *from)
{
    to->meta = from->meta;
    to->n_meta = from->n_meta;
    from->meta = NULL;
    from->n_meta = 0;
    while (to->n_meta && (!strcmp(to->meta[to->n_meta - 1].key, ADCGS_NOTE_PLAN) ||
                          !strcmp(to->meta[to->n_meta - 1].key, ADCGS_NOTE_FOLLOWS))) {
        adcgs_meta *const last = &to->meta[--to->n_meta];
        adcgs_free(NULL, last->key);
        adcgs_free(NULL, last->value);
    }
}

/** Adds a part. digest: of the previous model before the call, and of this part's model afterwards. */
static adcgs_status add_part(adcgs_stream *stream, adcgs_stream *one, const adcgs_plan *plan, uint32_t part, const char *base,
                             uint8_t digest[16], adcgs_error *error)
{
    char before[33];
    adcgs_md5_hex(digest, before);
    if (plan->segments[part].follows && strcmp(before, note_of(one, ADCGS_NOTE_FOLLOWS)))
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s.%u.adcgs: was trained from another %s.%u.adcgs: train it again", base,
                          part + 1, base, part);
    adcgs_model_digest(&one->segments[0], digest);
    if (!part)
        ADCGS_TRY(begin(stream, one, plan->cuts.n, error));
    if (plan->segments[part].follows)
        ADCGS_TRY(adcgs_encode_predict(&one->segments[0], &stream->segments[part - 1], error));
    adcgs_encode_place(stream, &plan->cuts, part, &one->segments[0]);
    if (part + 1 == plan->cuts.n)
        take_notes(stream, one);
    return ADCGS_OK;
}

adcgs_status adcgs_plan_join(adcgs_stream *stream, const adcgs_plan *plan, const char *base, adcgs_cpu_level cpu,
                             adcgs_pool *pool, adcgs_error *error)
{
    uint8_t digest[16] = {0};
    adcgs_stream_init(stream);
    for (uint32_t i = 0; i < plan->cuts.n; i++) {
        adcgs_stream one;
        adcgs_status status = need_part(&one, plan, base, i, cpu, pool, error);
        if (status == ADCGS_OK)
            status = add_part(stream, &one, plan, i, base, digest, error);
        adcgs_stream_clear(&one, NULL);
        ADCGS_TRY(status);
    }
    return ADCGS_OK;
}
