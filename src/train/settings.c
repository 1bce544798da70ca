/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The settings of a run by name: what a preset holds, a user may change. */
#include "train/schedule.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

typedef enum setting_kind { REAL, INT, WORD, BYTE } setting_kind;

typedef struct setting {
    const char *name;
    setting_kind kind;
    size_t offset;
    double min, max;
} setting;

#define AT(kind, field, min, max) { #field, kind, offsetof(adcgs_train_config, field), min, max }
#define PARAM(kind, field, min, max) { #field, kind, offsetof(adcgs_train_config, params.field), min, max }
#define SHAPE(kind, field, min, max) { #field, kind, offsetof(adcgs_train_config, shape.field), min, max }

static const setting settings[] = {
    PARAM(BYTE, k, 1, ADCGS_K_MAX),
    PARAM(BYTE, n_fv, 1, ADCGS_NV_MAX),
    PARAM(BYTE, n_fg, 0, ADCGS_NG_MAX),
    PARAM(BYTE, chunks, 1, ADCGS_CHUNKS_MAX),
    PARAM(BYTE, n_eta, 0, ADCGS_ETA_MAX),
    PARAM(BYTE, octaves, 0, ADCGS_OCTAVES_MAX),
    PARAM(BYTE, fine_uses_fv, 0, 1),
    PARAM(BYTE, coarse_rotation, 0, 1),
    PARAM(BYTE, adaptive_steps, 0, 1),
    PARAM(WORD, time_rows, 0, ADCGS_TIME_ROWS_MAX),
    PARAM(WORD, time_width, 0, ADCGS_TIME_WIDTH_MAX),
    SHAPE(INT, theta_width, 1, 512),
    SHAPE(INT, theta_hidden, 1, 3),
    SHAPE(INT, omega_width, 0, 512),
    SHAPE(INT, omega_hidden, 1, 3),
    SHAPE(INT, varpi_width, 0, 512),
    SHAPE(INT, varpi_hidden, 1, 3),
    SHAPE(INT, entropy_width, 1, 512),
    SHAPE(INT, entropy_hidden, 1, 3),
    SHAPE(INT, depth, 4, 21),
    SHAPE(REAL, step_fv, 1e-4, 10),
    SHAPE(REAL, step_fg, 1e-4, 10),
    SHAPE(REAL, step_sigma, 1e-4, 10),
    SHAPE(REAL, step_colour, 1e-4, 10),
    AT(REAL, lambda, 0, 1000),
    AT(REAL, ssim_weight, 0, 1),
    AT(INT, start_anchors, 1, ADCGS_ANCHORS_MAX),
    AT(INT, max_anchors, 1, ADCGS_ANCHORS_MAX),
    AT(REAL, densify_threshold, 0, 1e6),
    AT(REAL, prune_opacity, 0, 1),
    AT(REAL, keep_opacity, 0, 1),
    AT(INT, densify_every, 1, 1e6),
    AT(INT, rate_period, 1, 1000),
    AT(REAL, rdo_strength, 0, 1000),
    AT(REAL, dropout, 0, 0.9),
    AT(REAL, network_rate, 0, 1000),
    AT(REAL, still_below, 0, 1e6),
    AT(REAL, rigid_weight, 0, 1000),
    AT(REAL, scale_weight, 0, 1000),
    AT(REAL, average_last, 0, 1),
    AT(REAL, curriculum_begin, 0, 1),
    AT(REAL, curriculum_until, 0, 2),
    AT(REAL, quarter_until, 0, 2),
    AT(REAL, half_until, 0, 2),
    AT(REAL, scale_from, 0, 2),
    AT(REAL, deform_from, 0, 2),
    AT(REAL, fine_from, 0, 2),
    AT(REAL, densify_from, 0, 2),
    AT(REAL, densify_until, 0, 2),
    AT(REAL, noise_from, 0, 2),
    AT(REAL, rate_from, 0, 2),
    AT(REAL, prune_units_at, 0, 2),
    AT(REAL, prune_units_again, 0, 2),
    AT(REAL, decide_at, 0, 2),
    AT(REAL, round_from, 0, 2),
    AT(REAL, freeze_from, 0, 2),
};

static double get(const adcgs_train_config *c, const setting *s)
{
    const void *at = (const char *)c + s->offset;
    switch (s->kind) {
    case REAL: return (double)*(const float *)at;
    case INT: return *(const int *)at;
    case WORD: return *(const uint16_t *)at;
    default: return *(const uint8_t *)at;
    }
}

static void put(adcgs_train_config *c, const setting *s, double value)
{
    void *at = (char *)c + s->offset;
    switch (s->kind) {
    case REAL: *(float *)at = (float)value; break;
    case INT: *(int *)at = (int)value; break;
    case WORD: *(uint16_t *)at = (uint16_t)value; break;
    default: *(uint8_t *)at = (uint8_t)value; break;
    }
}

static adcgs_status set_one(adcgs_train_config *c, const char *text, size_t length, adcgs_error *error)
{
    const char *equals = memchr(text, '=', length);
    const size_t name = equals ? (size_t)(equals - text) : length;
    for (size_t i = 0; i < ADCGS_COUNTOF(settings); i++) {
        const setting *s = &settings[i];
        if (strlen(s->name) != name || memcmp(s->name, text, name) != 0)
            continue;
        char *end = NULL;
        const double value = equals ? strtod(equals + 1, &end) : NAN;
        if (!equals || end == equals + 1 || end != text + length || !(value >= s->min && value <= s->max) ||
            (s->kind != REAL && value != floor(value)))
            return adcgs_fail(error, ADCGS_ERR_USAGE, "bad setting '%.*s': expected %s=%s from %g to %g", (int)length, text,
                              s->name, s->kind == REAL ? "NUMBER" : "INTEGER", s->min, s->max);
        put(c, s, value);
        c->own_anchors |= s->offset == offsetof(adcgs_train_config, max_anchors);
        c->own_rigid |= s->offset == offsetof(adcgs_train_config, rigid_weight);
        c->own_scale_from |= s->offset == offsetof(adcgs_train_config, scale_from);
        c->own_networks |= s->offset >= offsetof(adcgs_train_config, shape.theta_width) &&
                           s->offset <= offsetof(adcgs_train_config, shape.entropy_hidden);
        return ADCGS_OK;
    }
    return adcgs_fail(error, ADCGS_ERR_USAGE, "unknown setting '%.*s'", (int)name, text);
}

adcgs_status adcgs_train_set(adcgs_train_config *config, const char *text, adcgs_error *error)
{
    while (*text) {
        const size_t length = strcspn(text, ",");
        ADCGS_TRY(set_one(config, text, length, error));
        text += length + (text[length] == ',');
    }
    if (config->params.n_fg % config->params.chunks)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "bad settings: n_fg = %d is not a multiple of chunks = %d", config->params.n_fg,
                          config->params.chunks);
    return ADCGS_OK;
}

/* ---- Parts left out ---- */

/** Each primitive becomes an anchor of its own. */
static void leave_out_anchors(adcgs_train_config *c)
{
    c->start_anchors = (uint32_t)ADCGS_MIN((uint64_t)c->start_anchors * c->params.k, ADCGS_ANCHORS_MAX);
    c->max_anchors = (uint32_t)ADCGS_MIN((uint64_t)c->max_anchors * c->params.k, ADCGS_ANCHORS_MAX);
    c->params.k = c->params.chunks = 1;
    c->params.n_fg = 0;
}

adcgs_status adcgs_train_leave_out(adcgs_train_config *c, const char *parts, adcgs_error *error)
{
    enum { COARSE = 1, FINE = 2, RATE = 4, REFINEMENT = 8, ANCHORS = 16, LATTICE = 32, REMOVAL = 64 };
    static const struct {
        const char *name;
        int bits;
    } known[] = { { "none", 0 },           { "coarse", COARSE },         { "fine", FINE },       { "deformation", COARSE | FINE },
                  { "rate", RATE },        { "refinement", REFINEMENT }, { "anchors", ANCHORS },
                  { "lattice", LATTICE },  { "removal", REMOVAL } };
    int bits = 0;
    for (const char *at = parts;; at++) {
        const size_t length = strcspn(at, ",");
        size_t i = 0;
        while (i < ADCGS_COUNTOF(known) && (strlen(known[i].name) != length || memcmp(known[i].name, at, length) != 0))
            i++;
        if (i == ADCGS_COUNTOF(known))
            return adcgs_fail(error, ADCGS_ERR_USAGE,
                              "cannot leave out '%.*s': expected none, coarse, fine, deformation, rate, refinement, anchors, "
                              "removal or lattice", (int)length, at);
        bits |= known[i].bits;
        at += length;
        if (!*at)
            break;
    }
    c->without_coarse = (bits & COARSE) != 0;
    c->without_fine = (bits & FINE) != 0;
    c->without_rate = (bits & RATE) != 0;
    c->without_densification = (bits & REFINEMENT) != 0;
    c->without_weight_steps = (bits & LATTICE) != 0;
    if (bits & ANCHORS)
        leave_out_anchors(c);
    if (bits & REMOVAL)
        c->prune_units_at = c->decide_at = 2;
    if (bits & REFINEMENT)
        c->start_anchors = c->max_anchors;
    return ADCGS_OK;
}

void adcgs_train_settings(const adcgs_train_config *config, FILE *file)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(settings); i++)
        fprintf(file, "%-16s %-10.6g %g to %g\n", settings[i].name, get(config, &settings[i]), settings[i].min, settings[i].max);
}
