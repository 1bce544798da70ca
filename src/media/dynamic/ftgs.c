/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Reads FTGS PLY version 1, of FreeTimeGS (Wang et al., 2025): positions are linear in time, opacities fade with a half in the
 * exponent. Time runs from 0 to 1; frame i is at i / (frames - 1). Comments of the header hold its settings. The comment
 * opacity_floor is not read and counts as zero: else thousands of splats that have gone add up.
 */
#include "config.h"

#include "media/dynamic/activate.h"
#include "media/dynamic/motion.h"
#include "media/dynamic/ply_columns.h"
#include "media/dynamic/dynamic_readers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FRAMES_UNSTATED 300                     /* frames of a clip without n_frames; literature (ftgs-player) */
#define OWN 5                                   /* columns that static splats lack; definition (FTGS) */
#define COLUMNS (ADCGS_PLY_SPLAT_COLUMNS + OWN) /* columns besides harmonics; arithmetic */
#define REST_MAX 45                             /* columns of harmonics, at most; arithmetic, 3 (4^2 - 1) */

/** The comments of a header. */
typedef struct settings {
    double degree, moves, shortest, frames;
} settings;

typedef struct reader {
    adcgs_ply *ply;
    settings is;
    int n_rest;
    adcgs_motion *motion;
} reader;

static int is_ftgs(const uint8_t *data, size_t bytes)
{
    return adcgs_ply_is(data, bytes) &&
           (adcgs_ply_declares(data, bytes, "log_duration") || adcgs_ply_declares(data, bytes, "ftgs_version"));
}

/* ---- Comments ---- */

/** The value of the comment "KEY VALUE" as a text without white space; "" if there is none. */
static void find_comment(const adcgs_ply *ply, const char *key, char value[32])
{
    const char *at = NULL;
    char text[128], name[64];
    size_t n;
    *value = 0;
    while (adcgs_ply_comment(ply, &at, &n)) {
        snprintf(text, sizeof text, "%.*s", (int)(n < sizeof text ? n : 0), at);
        if (sscanf(text, "%63s %31s", name, value) == 2 && !strcmp(name, key))
            return;
        *value = 0;
    }
}

/** A number of the header. */
typedef struct setting {
    const char *key;
    double low, high;
    double standard; /**< without the comment; NAN if the format requires it */
    int is_whole;
    double *out;
} setting;

static adcgs_status read_number(const adcgs_ply *ply, const setting *s)
{
    char value[32], *end;
    find_comment(ply, s->key, value);
    *s->out = *value ? strtod(value, &end) : s->standard;
    if (!*value && isnan(s->standard))
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: no comment %s, which FTGS PLY requires", ply->path, s->key);
    if (*value && (*end || !(*s->out >= s->low && *s->out <= s->high) || (s->is_whole && *s->out != floor(*s->out))))
        return adcgs_fail(ply->error, ADCGS_ERR_DATA, "%s: comment %s: %s, expected %s from %g to %g", ply->path, s->key, value,
                          s->is_whole ? "a whole number" : "a number", s->low, s->high);
    return ADCGS_OK;
}

static adcgs_status read_settings(const adcgs_ply *ply, settings *out)
{
    char value[32];
    double version;
    const setting first = {"ftgs_version", 0.0, 1e9, NAN, 0, &version};
    const setting others[] = {{"sh_degree", 0.0, ADCGS_SPLATS_DEGREE_MAX, NAN, 1, &out->degree},
                              {"use_velocity", 0.0, 1.0, NAN, 1, &out->moves},
                              {"min_duration", 0.0, 1e6, NAN, 0, &out->shortest},
                              {"n_frames", 1.0, ADCGS_DYNAMIC_FRAMES_MAX, FRAMES_UNSTATED, 1, &out->frames}};
    ADCGS_TRY(read_number(ply, &first));
    if (version != 1.0)
        return adcgs_fail(ply->error, ADCGS_ERR_UNSUPPORTED, "%s: FTGS PLY version %g, expected version 1", ply->path, version);
    find_comment(ply, "time_units", value);
    if (strcmp(value, "normalized"))
        return adcgs_fail(ply->error, ADCGS_ERR_UNSUPPORTED, "%s: comment time_units: %s, expected normalized", ply->path,
                          *value ? value : "missing");
    for (size_t i = 0; i < ADCGS_COUNTOF(others); i++)
        ADCGS_TRY(read_number(ply, &others[i]));
    return ADCGS_OK;
}

/* ---- Rows ---- */

/** The harmonics' columns are channel-major, as those of splats. */
static adcgs_status with_columns(reader *r, adcgs_ply_columns_fn use)
{
    adcgs_motion *const m = r->motion;
    adcgs_splats *const s = &m->base;
    const adcgs_ply_column own[OWN] = {
        {"time", m->centre, 1},
        {"log_duration", m->sigma, 1},
        {"velocity_0", m->motion[0][0], 1},
        {"velocity_1", m->motion[0][1], 1},
        {"velocity_2", m->motion[0][2], 1},
    };
    adcgs_ply_column columns[COLUMNS + REST_MAX];
    char names[REST_MAX][32];
    const int n = r->is.moves != 0.0 ? COLUMNS : COLUMNS - 3;
    adcgs_ply_splat_columns(columns, s);
    memcpy(columns + ADCGS_PLY_SPLAT_COLUMNS, own, sizeof own);
    for (int i = 0; i < r->n_rest; i++) {
        snprintf(names[i], sizeof names[i], "f_rest_%d", i);
        columns[n + i] = (adcgs_ply_column){names[i], s->harmonics ? s->harmonics + i : NULL, (size_t)r->n_rest};
    }
    return use(r->ply, columns, (size_t)(n + r->n_rest));
}

/** Numbers before activation become those of a motion; seconds: of the unit of time. */
static adcgs_status activate(reader *r, double seconds)
{
    adcgs_motion *const m = r->motion;
    adcgs_splats_activate(&m->base);
    for (uint32_t i = 0; i < m->base.n; i++) {
        const double duration = exp((double)m->sigma[i]);
        m->sigma[i] = (float)(duration < r->is.shortest ? r->is.shortest : duration); /* NAN stays */
        for (int a = 0; a < 3; a++)
            m->base.colour[a][i] = (float)(0.5 + ADCGS_SPLATS_DC * (double)m->base.colour[a][i]);
    }
    adcgs_motion_stretch(m, seconds);
    return adcgs_motion_check(m, r->ply->path, r->ply->error);
}

/** The number of harmonics' columns follows from sh_degree; the header must agree. */
static adcgs_status count_rest(reader *r)
{
    char next[32];
    const int d = (int)r->is.degree + 1;
    r->n_rest = 3 * (d * d - 1);
    snprintf(next, sizeof next, "f_rest_%d", r->n_rest);
    if (adcgs_ply_find(r->ply, next))
        return adcgs_fail(r->ply->error, ADCGS_ERR_DATA, "%s: it has %s, expected %d harmonics for sh_degree %d", r->ply->path,
                          next, r->n_rest, d - 1);
    return ADCGS_OK;
}

static adcgs_status read(adcgs_dynamic *m, reader *r)
{
    adcgs_splats *const s = &r->motion->base;
    adcgs_error *const error = r->ply->error;
    ADCGS_TRY(read_settings(r->ply, &r->is));
    ADCGS_TRY(count_rest(r));
    ADCGS_TRY(with_columns(r, adcgs_ply_find_columns)); /* before memory is allocated for them */
    ADCGS_TRY(adcgs_motion_alloc(r->motion, r->ply->vertex.count, r->is.moves != 0.0, 0, m->path, error));
    s->degree = (int)r->is.degree;
    s->harmonics = r->n_rest ? calloc((size_t)s->n * (size_t)r->n_rest + 1, sizeof *s->harmonics) : NULL;
    if (r->n_rest && !s->harmonics)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory for %u splats", m->path, s->n);
    ADCGS_TRY(with_columns(r, adcgs_ply_columns));
    adcgs_dynamic_set_clock(m, (adcgs_fps){0, 0}, (uint32_t)r->is.frames);
    m->n = s->n;
    m->has_identity = m->is_continuous = 1;
    return activate(r, ADCGS_MAX(m->frames - 1, 1) / adcgs_fps_value(m->rate));
}

static adcgs_status open_ftgs(adcgs_dynamic *m, adcgs_error *error)
{
    reader r = {.motion = calloc(1, sizeof *r.motion)};
    m->state = r.motion;
    if (!r.motion)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "%s: out of memory", m->path);
    ADCGS_TRY(adcgs_ply_open(&r.ply, m->data, m->bytes, m->path, error));
    const adcgs_status status = read(m, &r);
    adcgs_ply_close(&r.ply);
    return status;
}

const adcgs_dynamic_reader adcgs_dynamic_ftgs =
    {"FTGS PLY", is_ftgs, 0, open_ftgs, adcgs_dynamic_motion_at, adcgs_dynamic_motion_close};
