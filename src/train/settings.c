/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Settings by name: reading, writing, comparison and lists, all from one table. */
#include "train/settings.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/* ---- One setting ---- */

/** The row of a former name of this length; NULL if there is none. */
static const adcgs_setting_former *find_former(const char *name, size_t length)
{
    const adcgs_setting_former *former = adcgs_settings_former;
    while (former->name && (strlen(former->name) != length || memcmp(former->name, name, length) != 0))
        former++;
    return former->name ? former : NULL;
}

const adcgs_setting *adcgs_setting_find(const char *name)
{
    const adcgs_setting_former *const former = find_former(name, strlen(name));
    const char *const now = former ? former->now : name;
    const adcgs_setting *s = adcgs_settings;
    while (s->name && strcmp(s->name, now) != 0)
        s++;
    return s->name ? s : NULL;
}

const adcgs_setting_former *adcgs_setting_next_former(const char **list)
{
    while (**list) {
        const char *const name = *list;
        const size_t length = strcspn(name, "=,");
        *list += strcspn(name, ",");
        *list += **list == ',';
        const adcgs_setting_former *const former = find_former(name, length);
        if (former)
            return former;
    }
    return NULL;
}

void adcgs_setting_names(const char *names[ADCGS_SETTING_NAMES + 1])
{
    int n = 0;
    for (const adcgs_setting *s = adcgs_settings; s->name && n < ADCGS_SETTING_NAMES; s++)
        if (s->group != ADCGS_SETTING_SWITCHES)
            names[n++] = s->name;
    names[n] = NULL;
}

double adcgs_setting_get(const adcgs_setting *s, const adcgs_train_config *c)
{
    const void *at = (const char *)c + s->offset;
    switch (s->kind) {
    case ADCGS_SETTING_REAL:
        return (double)*(const float *)at;
    case ADCGS_SETTING_INT:
        return *(const int *)at;
    case ADCGS_SETTING_UINT32:
        return *(const uint32_t *)at;
    case ADCGS_SETTING_UINT64:
        return (double)*(const uint64_t *)at;
    case ADCGS_SETTING_UINT16:
        return *(const uint16_t *)at;
    default:
        return *(const uint8_t *)at;
    }
}

void adcgs_setting_put(const adcgs_setting *s, adcgs_train_config *c, double value)
{
    void *at = (char *)c + s->offset;
    switch (s->kind) {
    case ADCGS_SETTING_REAL:
        *(float *)at = (float)value;
        break;
    case ADCGS_SETTING_INT:
        *(int *)at = (int)value;
        break;
    case ADCGS_SETTING_UINT32:
        *(uint32_t *)at = (uint32_t)value;
        break;
    case ADCGS_SETTING_UINT64:
        *(uint64_t *)at = (uint64_t)value;
        break;
    case ADCGS_SETTING_UINT16:
        *(uint16_t *)at = (uint16_t)value;
        break;
    default:
        *(uint8_t *)at = (uint8_t)value;
        break;
    }
}

/** A number as the setting's field holds it: bounds and presets are decimals, fields may be binary32. */
static double as_held(const adcgs_setting *s, double value)
{
    return s->kind == ADCGS_SETTING_REAL ? (double)(float)value : value;
}

const char *adcgs_setting_print(const adcgs_setting *s, double value, char text[ADCGS_SETTING_TEXT])
{
    int digits = 1;
    if (value == floor(value) && fabs(value) < 1e16)
        snprintf(text, ADCGS_SETTING_TEXT, "%.0f", value);
    else
        do
            snprintf(text, ADCGS_SETTING_TEXT, "%.*g", digits, value);
        while (digits++ < 9 && as_held(s, strtod(text, NULL)) != as_held(s, value));
    return text;
}

static size_t preset_of(const adcgs_train_config *c)
{
    size_t i = 0;
    while (i + 1 < ADCGS_PRESETS && strcmp(adcgs_train_presets[i], c->preset) != 0)
        i++;
    return i;
}

int adcgs_setting_is_preset(const adcgs_setting *s, const adcgs_train_config *c)
{
    return adcgs_setting_get(s, c) == as_held(s, s->preset[preset_of(c)]);
}

int adcgs_setting_is_given(const adcgs_train_config *c, const char *name)
{
    return c->origin[adcgs_setting_find(name) - adcgs_settings].given;
}

int adcgs_setting_group_is_given(const adcgs_train_config *c, adcgs_setting_group group)
{
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        if (s->group == group && c->origin[s - adcgs_settings].given)
            return 1;
    return 0;
}

/* ---- Checks ---- */

int adcgs_setting_may_be(const adcgs_setting *s, double value)
{
    return value >= fmin(s->min, as_held(s, s->min)) && value <= fmax(s->max, as_held(s, s->max)) &&
           (s->kind == ADCGS_SETTING_REAL || value == floor(value));
}

static adcgs_status fail_range(const adcgs_setting *s, const char *given, adcgs_error *error)
{
    char min[ADCGS_SETTING_TEXT], max[ADCGS_SETTING_TEXT];
    return adcgs_fail(error, ADCGS_ERR_USAGE, "setting %s=%s: expected a %snumber from %s to %s", s->name, given,
                      s->kind == ADCGS_SETTING_REAL ? "" : "whole ", adcgs_setting_print(s, s->min, min),
                      adcgs_setting_print(s, s->max, max));
}

static adcgs_status check_ranges(const adcgs_train_config *c, adcgs_error *error)
{
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        const double value = adcgs_setting_get(s, c);
        char text[ADCGS_SETTING_TEXT];
        if (!adcgs_setting_may_be(s, value))
            return fail_range(s, adcgs_setting_print(s, value, text), error);
    }
    return ADCGS_OK;
}

static adcgs_status fail_relation(const adcgs_train_config *c, const char *a, const char *b, const char *expected,
                                  adcgs_error *error)
{
    const adcgs_setting *x = adcgs_setting_find(a), *y = adcgs_setting_find(b);
    char value[2][ADCGS_SETTING_TEXT];
    return adcgs_fail(error, ADCGS_ERR_USAGE, "settings %s=%s and %s=%s: expected %s", a,
                      adcgs_setting_print(x, adcgs_setting_get(x, c), value[0]), b,
                      adcgs_setting_print(y, adcgs_setting_get(y, c), value[1]), expected);
}

/** Checks the relations between settings. */
static adcgs_status check_relations(const adcgs_train_config *c, adcgs_error *error)
{
    if (c->params.n_fg % c->params.chunks)
        return fail_relation(c, "n_fg", "chunks", "a multiple of chunks", error);
    if (c->params.time_rows && !c->params.time_width)
        return fail_relation(c, "time_rows", "time_width", "a time_width of at least 1", error);
    if (c->start_anchors > c->max_anchors)
        return fail_relation(c, "start_anchors", "max_anchors", "at most max_anchors to start with", error);
    if (c->freeze_start < c->quant_round_start)
        return fail_relation(c, "freeze_start", "quant_round_start", "freeze_start not before quant_round_start", error);
    return ADCGS_OK;
}

static adcgs_status check_target(const adcgs_train_config *c, adcgs_error *error)
{
    const int size = c->target == ADCGS_TARGET_SIZE;
    const double min = size ? ADCGS_TARGET_SIZE_MIN : ADCGS_TARGET_PSNR_MIN;
    const double max = size ? ADCGS_TARGET_SIZE_MAX : ADCGS_TARGET_PSNR_MAX;
    if (!(c->time_limit >= 0 && c->time_limit <= ADCGS_TIME_LIMIT_MAX))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "time limit of %g s: expected 0 to %g", c->time_limit, ADCGS_TIME_LIMIT_MAX);
    if (c->target == ADCGS_TARGET_NONE)
        return ADCGS_OK;
    if (!(c->target_value >= min && c->target_value <= max))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "target of %g %s: expected %g to %g", c->target_value, size ? "bytes" : "dB",
                          min, max);
    if (c->without_rate || c->without_rounding)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "a target size or PSNR needs rate: remove --without rate and --uncompressed");
    if (adcgs_setting_is_given(c, "lambda"))
        return adcgs_fail(error, ADCGS_ERR_USAGE, "lambda=%g and a target size or PSNR, which controls it: expected one of them",
                          (double)c->lambda);
    return ADCGS_OK;
}

adcgs_status adcgs_train_check(const adcgs_train_config *c, adcgs_error *error)
{
    ADCGS_TRY(check_ranges(c, error));
    ADCGS_TRY(check_relations(c, error));
    return check_target(c, error);
}

/* ---- Making a configuration ---- */

adcgs_status adcgs_train_preset(adcgs_train_config *config, const char *name, adcgs_error *error)
{
    size_t i = 0;
    while (i < ADCGS_PRESETS && strcmp(adcgs_train_presets[i], name) != 0)
        i++;
    if (i == ADCGS_PRESETS)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "unknown preset '%s': expected draft, fast, medium, slow or paper", name);
    *config = (adcgs_train_config){.preset = adcgs_train_presets[i]};
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        adcgs_setting_put(s, config, s->preset[i]);
    return ADCGS_OK;
}

/**
 * Sets a value in range as the user's choice. If max_anchors is below the preset's start_anchors, start_anchors is lowered to it.
 */
static void choose(adcgs_train_config *c, const adcgs_setting *s, double value)
{
    adcgs_setting_put(s, c, value);
    c->origin[s - adcgs_settings].given = 1;
    if (s->offset == offsetof(adcgs_train_config, max_anchors) && !adcgs_setting_is_given(c, "start_anchors")) {
        const double start = adcgs_setting_find("start_anchors")->preset[preset_of(c)];
        c->start_anchors = (uint32_t)fmin(start, value);
    }
}

adcgs_status adcgs_train_set_value(adcgs_train_config *config, const char *name, double value, adcgs_error *error)
{
    const adcgs_setting *s = adcgs_setting_find(name);
    char text[ADCGS_SETTING_TEXT];
    if (!s || s->group == ADCGS_SETTING_SWITCHES)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "unknown setting '%s': --set list shows all settings", name);
    if (!adcgs_setting_may_be(s, value)) {
        snprintf(text, sizeof text, "%.9g", value);
        return fail_range(s, text, error);
    }
    choose(config, s, value);
    return ADCGS_OK;
}

/** Sets one "name=value"; modifies the text. */
static adcgs_status set_one(adcgs_train_config *c, char *text, adcgs_error *error)
{
    char *const equals = strchr(text, '='), *end = NULL;
    if (equals)
        *equals = 0;
    double value = equals ? strtod(equals + 1, &end) : 0;
    if (equals && end > equals + 1 && *end && !end[1] && strchr("kKM", *end)) /* thousands, millions */
        value *= *end++ == 'M' ? 1e6 : 1e3;
    const adcgs_setting *s = adcgs_setting_find(text);
    if (s && s->group != ADCGS_SETTING_SWITCHES && (!equals || end == equals + 1 || *end || !adcgs_setting_may_be(s, value)))
        return fail_range(s, equals ? equals + 1 : "", error);
    return adcgs_train_set_value(c, text, value, error);
}

adcgs_status adcgs_train_set(adcgs_train_config *config, const char *text, adcgs_error *error)
{
    for (const char *at = text; *at;) {
        const size_t length = strcspn(at, ",");
        char one[100];
        if (length >= sizeof one)
            return adcgs_fail(error, ADCGS_ERR_USAGE, "setting '%.60s...': expected NAME=VALUE", at);
        memcpy(one, at, length);
        one[length] = 0;
        ADCGS_TRY(set_one(config, one, error));
        at += length + (at[length] == ',');
    }
    return ADCGS_OK;
}

/* ---- Lists ---- */

const char *adcgs_setting_in_list(const char *list, const char *name)
{
    const size_t n = strlen(name);
    for (const char *at = list; at; at = strchr(at, ',')) {
        at += *at == ',';
        if (!strncmp(at, name, n) && at[n] == '=')
            return at + n + 1;
    }
    return NULL;
}

adcgs_status adcgs_train_changes(const adcgs_train_config *c, adcgs_buffer *text, adcgs_error *error)
{
    static const char *const told_apart[] = {"lambda", "iterations", "seed"};
    const size_t begin = text->size;
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        char value[ADCGS_SETTING_TEXT], one[100];
        int apart = 0;
        for (size_t i = 0; i < ADCGS_COUNTOF(told_apart); i++)
            apart |= !strcmp(s->name, told_apart[i]);
        if (apart || adcgs_setting_is_preset(s, c))
            continue;
        const int n = snprintf(one, sizeof one, "%s%s=%s", text->size > begin ? "," : "", s->name,
                               adcgs_setting_print(s, adcgs_setting_get(s, c), value));
        adcgs_write_bytes(text, one, (size_t)n);
    }
    adcgs_write_uint(text, 0, 1);
    return text->failed ? adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for the list of settings") : ADCGS_OK;
}

static void list_one(const adcgs_setting *s, const adcgs_train_config *c, FILE *file)
{
    static const char letters[] = "SBQM";
    char value[ADCGS_SETTING_TEXT], min[ADCGS_SETTING_TEXT], max[ADCGS_SETTING_TEXT], affects[] = "----";
    for (int i = 0; i < 4; i++)
        if (s->affects & 1 << i)
            affects[i] = letters[i];
    fprintf(file, "  %-26s %-8s %s  %s (%s to %s)\n", s->name, adcgs_setting_print(s, adcgs_setting_get(s, c), value), affects,
            s->help, adcgs_setting_print(s, s->min, min), adcgs_setting_print(s, s->max, max));
}

void adcgs_train_list(const adcgs_train_config *config, FILE *file)
{
    static const char *const titles[] = {
        [ADCGS_SETTING_RUN] = "Run",
        [ADCGS_SETTING_LOSS] = "Loss",
        [ADCGS_SETTING_MODEL] = "Model",
        [ADCGS_SETTING_NETWORKS] = "Networks",
        [ADCGS_SETTING_STEPS] = "Grid and quantiser steps",
        [ADCGS_SETTING_ANCHORS] = "Anchors",
        [ADCGS_SETTING_TIMES] = "Times, as fractions of the run; above 1: never",
    };
    fprintf(file,
            "Settings of preset %s: name, value, effects, meaning, range.\n"
            "S: speed, B: bytes of the file, Q: quality, M: memory in training.\n",
            config->preset);
    fprintf(file, "\nCommon settings\n");
    for (const adcgs_setting *s = adcgs_settings; s->name; s++)
        if (s->class == ADCGS_SETTING_COMMON)
            list_one(s, config, file);
    int group = -1;
    for (const adcgs_setting *s = adcgs_settings; s->name; s++) {
        if (s->group == ADCGS_SETTING_SWITCHES || s->class == ADCGS_SETTING_COMMON)
            continue;
        if ((int)s->group != group)
            fprintf(file, "\nResearch: %s\n", titles[s->group]);
        group = (int)s->group;
        list_one(s, config, file);
    }
}
