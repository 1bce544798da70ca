/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Parsing the members of TSOG's meta.json that SOG does not have. */
#include "config.h"

#include "media/dynamic/tsog_meta.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>

/* Origin, unless a line states one: definition (TSOG, its profile of playback). */
#define META_VERSION 4 /* of meta.json */
#define PROFILE "org.opsiclear.tsog-playback"
#define PROFILE_VERSION 1 /* of the profile */
#define TICKS 65536       /* of a discrete timeline */
#define RATE 30           /* frames per second without a stated rate */
#define SECONDS_MAX 1e5   /* of a clip; chosen by hand, not measured */

typedef struct reader {
    const char *path;
    adcgs_error *error;
    json_t *root;
    adcgs_tsog_meta *out;
} reader;

int adcgs_tsog_meta_is(const uint8_t *text, size_t bytes)
{
    json_t *const root = json_loadb((const char *)text, bytes, 0, NULL);
    const int found = json_object_get(root, "timeline") || json_object_get(root, "temporal") ||
                      json_integer_value(json_object_get(root, "version")) == META_VERSION;
    json_decref(root);
    return found;
}

static adcgs_status bad(const reader *r, const char *member, const char *expected)
{
    return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: meta.json: %s: expected %s", r->path, member, expected);
}

/* ---- Images ---- */

/** Read n finite numbers of a list. \return 0 for any other value */
static int read_numbers(const json_t *list, double *out, size_t n)
{
    if (json_array_size(list) != n)
        return 0;
    for (size_t i = 0; i < n; i++) {
        out[i] = json_number_value(json_array_get(list, i));
        if (!json_is_number(json_array_get(list, i)) || !isfinite(out[i]))
            return 0;
    }
    return 1;
}

/** Read the names of at least `least` and at most two images. */
static adcgs_status read_images(const reader *r, const json_t *object, const char *member, size_t least, adcgs_tsog_image *out)
{
    const json_t *const list = json_object_get(object, "files");
    const size_t n = json_array_size(list);
    if (n < least || n > 2)
        return bad(r, member, least == 2 ? "files: names of two images" : "files: names of one or two images");
    for (size_t i = 0; i < n; i++) {
        const char *const name = json_string_value(json_array_get(list, i));
        if (!name || !*name || strlen(name) >= sizeof out->name[i])
            return bad(r, member, "files: names of images");
        snprintf(out->name[i], sizeof out->name[i], "%s", name);
    }
    out->n = (int)n;
    return ADCGS_OK;
}

/* ---- Members ---- */

static adcgs_status read_discrete(const reader *r, const json_t *timeline)
{
    const json_t *const count = json_object_get(timeline, "N"), *const delta = json_object_get(timeline, "delta");
    const json_int_t n = json_integer_value(count), width = delta ? json_integer_value(delta) : n > 0 ? TICKS / n : 0;
    if (n < 1 || n > TICKS)
        return bad(r, "timeline", "N: 1 to 65536 frames");
    if (width < 1 || width > TICKS)
        return bad(r, "timeline", "delta: 1 to 65536");
    r->out->kind = ADCGS_TSOG_DISCRETE;
    r->out->frames = (uint32_t)n;
    r->out->delta = (uint32_t)width;
    return ADCGS_OK;
}

static adcgs_status read_continuous(const reader *r, const json_t *timeline)
{
    adcgs_tsog_image *const image = &r->out->timeline;
    if (!read_numbers(json_object_get(timeline, "mins"), image->low, 2) ||
        !read_numbers(json_object_get(timeline, "maxs"), image->high, 2))
        return bad(r, "timeline", "mins and maxs: two numbers each");
    if (image->low[1] < 0.0 || image->high[1] < 0.0)
        return bad(r, "timeline", "mins and maxs: durations that are not negative");
    r->out->kind = ADCGS_TSOG_CONTINUOUS;
    return ADCGS_OK;
}

static adcgs_status read_timeline(const reader *r)
{
    const json_t *const timeline = json_object_get(r->root, "timeline"), *const type = json_object_get(timeline, "type");
    if (!timeline || json_is_null(timeline))
        return ADCGS_OK;
    const json_int_t number = json_integer_value(type);
    if (!json_is_integer(type))
        return bad(r, "timeline", "type: 0 (discrete) or 1 (continuous)");
    if (number != 0 && number != 1)
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: TSOG's timeline of type %lld, expected 0 (discrete) or 1",
                          r->path, (long long)number);
    ADCGS_TRY(number ? read_continuous(r, timeline) : read_discrete(r, timeline));
    return read_images(r, timeline, "timeline", 2, &r->out->timeline);
}

/** Changes over time. One that is not known changes splats, so it is refused. */
static adcgs_status read_temporal(const reader *r)
{
    json_t *const temporal = json_object_get(r->root, "temporal");
    adcgs_tsog_image *const image = &r->out->velocity;
    for (void *at = json_object_iter(temporal); at; at = json_object_iter_next(temporal, at))
        if (strcmp(json_object_iter_key(at), "means"))
            return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED, "%s: TSOG with temporal.%.40s, expected only temporal.means",
                              r->path, json_object_iter_key(at));
    const json_t *const means = json_object_get(temporal, "means");
    if (!means)
        return ADCGS_OK;
    if (r->out->kind != ADCGS_TSOG_CONTINUOUS)
        return bad(r, "temporal", "a continuous timeline, of type 1");
    if (!read_numbers(json_array_get(json_object_get(means, "mins"), 0), image->low, 3) ||
        !read_numbers(json_array_get(json_object_get(means, "maxs"), 0), image->high, 3))
        return bad(r, "temporal.means", "mins and maxs: a list of three numbers each");
    return read_images(r, means, "temporal.means", 1, image);
}

static adcgs_status read_profile(const reader *r)
{
    const json_t *const profile = json_object_get(r->root, "profile");
    const char *const id = json_string_value(json_object_get(profile, "id"));
    const json_int_t version = json_integer_value(json_object_get(profile, "version"));
    if (profile && (!id || strcmp(id, PROFILE) || version != PROFILE_VERSION))
        return adcgs_fail(r->error, ADCGS_ERR_UNSUPPORTED,
                          "%s: TSOG's profile %.60s version %lld, expected " PROFILE " version 1", r->path, id ? id : "(none)",
                          (long long)version);
    return ADCGS_OK;
}

/** Read a number of the clip: *out keeps its value without one. */
static adcgs_status read_clip(const reader *r, const json_t *object, const char *key, double least, double most, double *out)
{
    const json_t *const value = json_object_get(object, key);
    if (!value || json_is_null(value))
        return ADCGS_OK;
    *out = json_number_value(value);
    if (!json_is_number(value) || !(*out >= least && *out <= most))
        return adcgs_fail(r->error, ADCGS_ERR_DATA, "%s: meta.json: %s: expected a number from %g to %g", r->path, key, least,
                          most);
    return ADCGS_OK;
}

static adcgs_status read_playback(const reader *r)
{
    const json_t *const playback = json_object_get(r->root, "playback");
    double rate = RATE;
    ADCGS_TRY(read_clip(r, r->root, "fps", ADCGS_FPS_MIN, ADCGS_FPS_MAX, &rate));
    ADCGS_TRY(read_clip(r, playback, "fps", ADCGS_FPS_MIN, ADCGS_FPS_MAX, &rate));
    ADCGS_TRY(read_clip(r, playback, "duration", 1.0 / ADCGS_FPS_MAX, SECONDS_MAX, &r->out->seconds));
    r->out->rate = adcgs_fps_of(rate);
    r->out->has_sound = json_is_object(json_object_get(r->root, "audio")) || json_is_object(json_object_get(playback, "audio"));
    return ADCGS_OK;
}

static adcgs_status read_members(const reader *r)
{
    ADCGS_TRY(read_profile(r));
    ADCGS_TRY(read_playback(r));
    ADCGS_TRY(read_timeline(r));
    return read_temporal(r);
}

adcgs_status adcgs_tsog_meta_parse(adcgs_tsog_meta *out, const uint8_t *text, size_t bytes, const char *path, adcgs_error *error)
{
    reader r = {.path = path, .error = error, .out = out};
    json_error_t where;
    *out = (adcgs_tsog_meta){0};
    r.root = json_loadb((const char *)text, bytes, JSON_REJECT_DUPLICATES, &where);
    if (!r.root)
        return adcgs_fail(error, ADCGS_ERR_DATA, "%s: meta.json: line %d: malformed JSON: %s", path, where.line, where.text);
    const adcgs_status status = read_members(&r);
    json_decref(r.root);
    return status;
}
