/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Reads plans and checks every field. */
#include "config.h"

#include "session/plan.h"

#include "base/cpu_detect.h"
#include "base/digest.h"
#include "scene/camera_json.h"
#include "scene/layouts/open.h"
#include "train/settings.h"

#include <math.h>
#include <stdlib.h>

/* Bounds of valid plans: seconds, and scene units of the world; chosen by hand, not measured. */
#define SECONDS_MAX 1e9
#define WORLD_MAX 1e12

/** Reports a wrong field of the plan or of a segment. */
#define BAD(at, field, ...) adcgs_json_bad(at, ADCGS_ERR_DATA, field, __VA_ARGS__)

/* ---- Fields ---- */

static adcgs_status need(const adcgs_json_place *at, const char *field, json_t **item)
{
    *item = json_object_get(at->frame ? at->frame : at->root, field);
    return *item ? ADCGS_OK : BAD(at, field, "missing");
}

static adcgs_status get_real(const adcgs_json_place *at, const char *field, double min, double max, double *value)
{
    int found;
    json_t *item;
    ADCGS_TRY(need(at, field, &item));
    return adcgs_json_number(at, field, min, max, value, &found);
}

static adcgs_status get_whole(const adcgs_json_place *at, const char *field, double min, double max, uint32_t *value)
{
    double x;
    ADCGS_TRY(get_real(at, field, min, max, &x));
    *value = (uint32_t)x;
    return x == floor(x) ? ADCGS_OK : BAD(at, field, "%g, expected a whole number", x);
}

/** *out: NULL if the field is null. */
static adcgs_status get_text(const adcgs_json_place *at, const char *field, char **out)
{
    json_t *item;
    ADCGS_TRY(need(at, field, &item));
    if (!json_is_string(item) && !json_is_null(item))
        return BAD(at, field, "expected a text");
    *out = json_is_string(item) ? strdup(json_string_value(item)) : NULL;
    return *out || json_is_null(item) ? ADCGS_OK : adcgs_json_bad(at, ADCGS_ERR_MEMORY, field, "out of memory");
}

static adcgs_status get_word(const adcgs_json_place *at, const char *field, char *out, size_t size)
{
    json_t *item;
    ADCGS_TRY(need(at, field, &item));
    const char *text = json_string_value(item);
    if (!text || strlen(text) >= size)
        return BAD(at, field, "expected a text of less than %zu bytes", size);
    memcpy(out, text, strlen(text) + 1);
    return ADCGS_OK;
}

/** Reads one of the names. */
static adcgs_status get_choice(const adcgs_json_place *at, const char *field, const char *const *names, int *index)
{
    char text[32];
    ADCGS_TRY(get_word(at, field, text, sizeof text));
    for (*index = 0; names[*index]; ++*index)
        if (!strcmp(names[*index], text))
            return ADCGS_OK;
    return BAD(at, field, "unknown value '%s'", text);
}

static adcgs_status get_reals(const adcgs_json_place *at, const char *field, double min, double max, double *x, size_t n)
{
    json_t *item;
    ADCGS_TRY(need(at, field, &item));
    if (!json_is_array(item) || json_array_size(item) != n)
        return BAD(at, field, "expected %zu numbers", n);
    for (size_t i = 0; i < n; i++) {
        json_t *const one = json_array_get(item, i);
        x[i] = json_number_value(one);
        if (!json_is_number(one) || !(x[i] >= min && x[i] <= max))
            return BAD(at, field, "expected %zu numbers from %g to %g", n, min, max);
    }
    return ADCGS_OK;
}

/* ---- Parts of a plan ---- */

static adcgs_status read_scene(const adcgs_json_place *at, adcgs_plan *p)
{
    double background[3];
    char *rate = NULL;
    json_t *alpha;
    ADCGS_TRY(get_text(at, "scene", &p->scene));
    ADCGS_TRY(get_text(at, "points", &p->points));
    ADCGS_TRY(get_text(at, "frames", &p->frames));
    ADCGS_TRY(get_choice(at, "dataset", adcgs_dataset_names, &p->dataset));
    ADCGS_TRY(get_text(at, "fps", &rate));
    const int bad = rate && adcgs_fps_parse(rate, &p->rate);
    free(rate);
    if (bad)
        return BAD(at, "fps", "expected frames per second");
    ADCGS_TRY(get_word(at, "outline", p->outline, sizeof p->outline));
    ADCGS_TRY(need(at, "alpha", &alpha));
    if (!json_is_boolean(alpha))
        return BAD(at, "alpha", "expected true or false");
    p->has_alpha = json_is_true(alpha);
    ADCGS_TRY(get_reals(at, "background", 0, 1, background, 3));
    for (int c = 0; c < 3; c++)
        p->background[c] = (float)background[c];
    return ADCGS_OK;
}

/** Requires every setting, and no others. */
static adcgs_status read_values(const adcgs_json_place *at, adcgs_train_config *c)
{
    json_t *values, *chosen, *item;
    size_t n = 0, i;
    ADCGS_TRY(need(at, "settings", &values));
    ADCGS_TRY(need(at, "chosen", &chosen));
    for (const adcgs_setting *s = adcgs_settings; s->name; s++, n++) {
        json_t *const one = json_object_get(values, s->name);
        if (!json_is_number(one) || !adcgs_setting_may_be(s, json_number_value(one)))
            return BAD(at, "settings", "%s: expected a %snumber from %g to %g", s->name,
                       s->kind == ADCGS_SETTING_REAL ? "" : "whole ", s->min, s->max);
        adcgs_setting_put(s, c, json_number_value(one));
    }
    if (json_object_size(values) != n)
        return BAD(at, "settings", "expected all %zu settings and no others", n);
    if (!json_is_array(chosen))
        return BAD(at, "chosen", "expected an array of names");
    json_array_foreach(chosen, i, item)
    {
        const adcgs_setting *const s = json_is_string(item) ? adcgs_setting_find(json_string_value(item)) : NULL;
        if (!s || s->group == ADCGS_SETTING_SWITCHES)
            return BAD(at, "chosen", "entry %zu is not a setting that a user can give", i);
        c->origin[s - adcgs_settings].given = 1;
    }
    return ADCGS_OK;
}

/** Reads a number that may be null. */
static adcgs_status get_given(const adcgs_json_place *at, const char *field, double min, double max, double *value, int *given)
{
    json_t *item;
    ADCGS_TRY(need(at, field, &item));
    *given = !json_is_null(item);
    return *given ? get_real(at, field, min, max, value) : ADCGS_OK;
}

static adcgs_status read_settings(const adcgs_json_place *at, adcgs_plan *p)
{
    adcgs_train_config *c = &p->config;
    adcgs_error why;
    double details = 0;
    int preset, level, has_psnr;
    ADCGS_TRY(get_choice(at, "cpu", adcgs_cpu_names, &level));
    p->cpu = (adcgs_cpu_level)level;
    if (!level)
        return BAD(at, "cpu", "expected the level of the kernels");
    ADCGS_TRY(get_choice(at, "preset", adcgs_train_presets, &preset));
    ADCGS_TRY(adcgs_train_preset(c, adcgs_train_presets[preset], at->error));
    ADCGS_TRY(read_values(at, c));
    ADCGS_TRY(get_given(at, "psnr", ADCGS_TARGET_PSNR_MIN, ADCGS_TARGET_PSNR_MAX, &c->target_value, &has_psnr));
    c->target = has_psnr ? ADCGS_TARGET_PSNR : ADCGS_TARGET_NONE;
    ADCGS_TRY(get_given(at, "details", 0, UINT32_MAX, &details, &p->has_details));
    p->details = (uint32_t)details;
    return adcgs_train_check(c, &why) == ADCGS_OK ? ADCGS_OK : BAD(at, "settings", "%.140s", why.text);
}

/** Reads a segment, which begins at the end of the previous one; at->frame is the segment. */
static adcgs_status read_segment(const adcgs_json_place *at, adcgs_plan *p)
{
    const uint32_t i = (uint32_t)at->index;
    double *const to = p->cuts.at, begin;
    uint32_t before;
    if (!json_is_object(at->frame))
        return adcgs_fail(at->error, ADCGS_ERR_DATA, "%s: segments[%u]: expected an object", at->path, i);
    ADCGS_TRY(get_real(at, "begin", 0, SECONDS_MAX, &begin));
    if (begin != (i ? to[i] : 0))
        return BAD(at, "begin", "%.9g, expected %.9g, the end of the previous segment", begin, i ? to[i] : 0);
    ADCGS_TRY(get_real(at, "end", begin, SECONDS_MAX, &to[i + 1]));
    if (!(to[i + 1] > begin))
        return BAD(at, "end", "%.9g, expected a time after its beginning", to[i + 1]);
    ADCGS_TRY(get_real(at, "crossfade", 0, i + 1 < p->cuts.n ? SECONDS_MAX : 0, &p->cuts.reach[i]));
    ADCGS_TRY(get_whole(at, "follows", 0, i, &before));
    if (before && before != i)
        return BAD(at, "follows", "%u, expected 0 or %u, the previous segment", before, i);
    p->segments[i].follows = before > 0;
    ADCGS_TRY(get_whole(at, "views", 1, UINT32_MAX, &p->segments[i].views));
    return get_real(at, "cost", 0, SECONDS_MAX, &p->segments[i].cost);
}

static adcgs_status read_segments(adcgs_json_place *at, adcgs_plan *p)
{
    size_t n;
    json_t *list = json_object_get(at->root, "segments");
    n = json_array_size(list);
    if (!n || n > UINT32_MAX / 64)
        return BAD(at, "segments", "expected an array of at least one segment");
    ADCGS_TRY(get_whole(at, "moments", 2, UINT32_MAX, &p->cuts.moments));
    p->cuts.n = (uint32_t)n;
    p->cuts.at = adcgs_alloc(NULL, n + 1, sizeof *p->cuts.at, at->error);
    p->cuts.reach = adcgs_alloc(NULL, n, sizeof *p->cuts.reach, at->error);
    p->segments = adcgs_alloc(NULL, n, sizeof *p->segments, at->error);
    if (!p->cuts.at || !p->cuts.reach || !p->segments)
        return adcgs_alloc_status(at->error);
    at->list = "segments";
    for (at->index = 0; at->index < n; at->index++) {
        at->frame = json_array_get(list, at->index);
        ADCGS_TRY(read_segment(at, p));
    }
    at->frame = NULL;
    return ADCGS_OK;
}

static adcgs_status read_coding(const adcgs_json_place *at, adcgs_plan *p)
{
    double base[2];
    ADCGS_TRY(get_reals(at, "origin", -WORLD_MAX, WORLD_MAX, p->origin, 3));
    ADCGS_TRY(get_real(at, "scale", 1 / WORLD_MAX, WORLD_MAX, &p->scale));
    ADCGS_TRY(get_reals(at, "time_base", 1, UINT32_MAX, base, 2));
    p->timebase_num = (uint32_t)base[0];
    p->timebase_den = (uint32_t)base[1];
    return base[0] == floor(base[0]) && base[1] == floor(base[1]) ? ADCGS_OK : BAD(at, "time_base", "expected whole numbers");
}

/** The digest covers the values in sorted order of their keys. */
static adcgs_status take_digest(const adcgs_json_place *at, adcgs_plan *p)
{
    uint8_t digest[16];
    adcgs_md5 md5;
    char *text = json_dumps(at->root, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    if (!text)
        return adcgs_fail(at->error, ADCGS_ERR_MEMORY, "%s: out of memory", at->path);
    adcgs_md5_init(&md5);
    adcgs_md5_update(&md5, text, strlen(text));
    adcgs_md5_final(&md5, digest);
    adcgs_md5_hex(digest, p->digest);
    free(text);
    return ADCGS_OK;
}

static adcgs_status read_plan(adcgs_json_place *at, adcgs_plan *p)
{
    json_t *const format = json_object_get(at->root, "adcgs_plan");
    if (!json_is_integer(format))
        return adcgs_fail(at->error, ADCGS_ERR_DATA, "%s: not a plan: no number adcgs_plan", at->path);
    if (json_integer_value(format) != ADCGS_PLAN_FORMAT)
        return adcgs_fail(at->error, ADCGS_ERR_UNSUPPORTED,
                          "%s: adcgs_plan: %lld, expected %d: use the version that made this "
                          "plan",
                          at->path, (long long)json_integer_value(format), ADCGS_PLAN_FORMAT);
    ADCGS_TRY(get_word(at, "encoder", p->encoder, sizeof p->encoder));
    ADCGS_TRY(read_scene(at, p));
    ADCGS_TRY(read_settings(at, p));
    ADCGS_TRY(read_coding(at, p));
    ADCGS_TRY(read_segments(at, p));
    return take_digest(at, p);
}

adcgs_status adcgs_plan_read(adcgs_plan *p, const char *path, adcgs_error *error)
{
    json_t *root;
    ADCGS_TRY(adcgs_json_load(&root, path, error));
    adcgs_json_place at = {.path = path, .root = root, .error = error};
    const adcgs_status status = read_plan(&at, p);
    json_decref(root);
    return status;
}
