/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The float model's memory, initial values and regrouping. */
#include "fmodel/fmodel.h"

#include "base/fmath.h"
#include "grad/random.h"
#include "splat/splat.h"
#include "splat/time_curve.h"

#include <math.h>

/* Initial values; chosen by hand, not measured, except for OPACITY_START (doc/log/initialisation.md). */
#define OPACITY_START (-2.0f) /* logit: opacity starts near 0.12; 0.5 and 0.05 lose on three scenes */
#define ENTROPY_START 0.02f   /* gain of the last layers of the entropy networks */
#define FV_START 0.1          /* standard deviation of f_v */
#define TIME_START 0.7        /* amplitude of column 0 of the time table */
#define TIME_FALL 0.3         /* column j has 1 / (1 + TIME_FALL j) of it */

/* Steps of quantisers; chosen by hand, not measured. */
#define STEP_REACH 64       /* maximum ratio of a trained step to its initial value, in both directions */
#define LEVELS_USED 480     /* steps: largest magnitude that widening allows; a margin below ADCGS_LEVEL_MAX */
#define STEP_LEAST 0x1p-20f /* magnitude below which values do not widen a step */

const uint8_t adcgs_fmodel_role[ADCGS_P_COUNT] = {
    [ADCGS_P_THETA] = ADCGS_ROLE_PREDICTION,
    [ADCGS_P_OMEGA] = ADCGS_ROLE_COARSE,
    [ADCGS_P_VARPI] = ADCGS_ROLE_FINE,
    [ADCGS_P_TIME] = ADCGS_ROLE_TIME,
    [ADCGS_P_E_FV] = ADCGS_ROLE_ENTROPY_FV,
    [ADCGS_P_E_SIGMA] = ADCGS_ROLE_ENTROPY_SIGMA,
    [ADCGS_P_E_COLOUR] = ADCGS_ROLE_ENTROPY_COLOUR,
    [ADCGS_P_E_FG] = ADCGS_ROLE_ENTROPY_FG,
    [ADCGS_P_E_FG + 1] = ADCGS_ROLE_ENTROPY_FG + 1,
    [ADCGS_P_E_FG + 2] = ADCGS_ROLE_ENTROPY_FG + 2,
    [ADCGS_P_E_FG + 3] = ADCGS_ROLE_ENTROPY_FG + 3,
    [ADCGS_P_E_STEPS] = ADCGS_ROLE_ENTROPY_STEPS,
};

int adcgs_fmodel_rows(const adcgs_fmodel *f, int group)
{
    switch (group) {
    case ADCGS_P_FV:
        return f->params.n_fv;
    case ADCGS_P_FG:
        return f->params.k * f->params.n_fg;
    case ADCGS_P_SIGMA:
        return adcgs_sigma_rows(&f->params);
    case ADCGS_P_COLOUR:
        return ADCGS_COLOUR_N;
    default:
        return f->params.n_eta;
    }
}

/* ---- Networks ---- */

void adcgs_fmodel_set_width(adcgs_fmodel *f, int group, int width)
{
    f->param[group].n = adcgs_mlp_set_width(&f->mlp[group], width);
}

static void layout_networks(adcgs_fmodel *f)
{
    const adcgs_params *p = &f->params;
    const adcgs_shape *s = &f->shape;
    const int fp = 6 * p->octaves, per_chunk = p->n_fg / p->chunks, own = p->n_fv + adcgs_slot_inputs(p) + p->n_fg;
    adcgs_mlp *m = f->mlp;
    adcgs_mlp_layout(&m[ADCGS_P_THETA], own, 0, s->theta_width, s->theta_hidden, ADCGS_THETA_OUT);
    if (p->time_rows) {
        if (s->omega_width)
            adcgs_mlp_layout(&m[ADCGS_P_OMEGA], p->n_fv, p->time_width, s->omega_width, s->omega_hidden,
                             p->coarse_rotation ? 12 : 9);
        if (s->varpi_width)
            adcgs_mlp_layout(&m[ADCGS_P_VARPI], fp + (p->fine_uses_fv ? p->n_fv : 0), p->time_width, s->varpi_width,
                             s->varpi_hidden, ADCGS_VARPI_OUT * p->k);
    }
    if (p->time_rows) { /* the time table: one tensor, no bias */
        adcgs_mlp *z = &m[ADCGS_P_TIME];
        memset(z, 0, sizeof *z);
        z->in[0] = adcgs_fmodel_time_columns(p);
        z->n_out[0] = p->time_rows;
        z->n = z->b[0] = (size_t)p->time_rows * (size_t)z->in[0];
        z->weight_step[0] = ADCGS_WEIGHT_STEP_NONE;
    }
    const int w = s->entropy_width, h = s->entropy_hidden;
    adcgs_mlp_layout(&m[ADCGS_P_E_FV], p->n_eta, 0, w, h, 2 * p->n_fv);
    adcgs_mlp_layout(&m[ADCGS_P_E_SIGMA], p->n_fv, 0, w, h, 2 * adcgs_sigma_rows(p));
    adcgs_mlp_layout(&m[ADCGS_P_E_COLOUR], p->n_fv, 0, w, h, 2 * ADCGS_COLOUR_N);
    for (int c = 0; c < p->chunks && per_chunk; c++)
        adcgs_mlp_layout(&m[ADCGS_P_E_FG + c], p->n_fv + c * per_chunk, 0, w, h, 2 * per_chunk);
    if (p->adaptive_steps)
        adcgs_mlp_layout(&m[ADCGS_P_E_STEPS], p->n_fv, 0, w, h, adcgs_params_steps(p));
    for (int i = ADCGS_P_E_FV; i < ADCGS_P_COUNT; i++)
        m[i].entropy = 1;
}

static const char *const names[ADCGS_P_COUNT] = {"f_v",   "f_g",   "sigma",     "colour", "eta",  "theta",   "omega",
                                                 "varpi", "time",  "eta prior", "steps",  "E_fv", "E_sigma", "E_colour",
                                                 "E_fg1", "E_fg2", "E_fg3",     "E_fg4",  "E_q"};

static adcgs_status param_alloc(adcgs_param *p, size_t n, adcgs_error *error)
{
    float *all = adcgs_alloc(NULL, 4 * (n + 16), sizeof *all, error);
    if (!all)
        return adcgs_alloc_status(error);
    const size_t stride = (n + 15) / 16 * 16;
    p->n = n;
    p->p = all;
    p->g = all + stride;
    p->m = all + 2 * stride;
    p->v = all + 3 * stride;
    return ADCGS_OK;
}

/**
 * Sines and cosines of half a cycle and more, with amplitudes that decrease with frequency. Adjacent times are similar from the
 * start, and motion starts smooth.
 */
static void start_time_table(adcgs_fmodel *f)
{
    const int rows = f->params.time_rows, width = f->params.time_width, columns = adcgs_fmodel_time_columns(&f->params);
    float *z = f->param[ADCGS_P_TIME].p;
    for (int r = 0; r < rows; r++, z += columns) {
        memset(z + width, 0, (size_t)(columns - width) * sizeof *z); /* at rest */
        for (int j = 0; j < width; j++) {
            const double phase = 3.14159265358979 * (0.5 + j / 2) * (rows > 1 ? (double)r / (rows - 1) - 0.5 : 0);
            z[j] = (float)((j % 2 ? cos(phase) : sin(phase)) * TIME_START / (1 + TIME_FALL * j));
        }
    }
}

static adcgs_status create_networks(adcgs_fmodel *f, uint64_t seed, adcgs_error *error)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        adcgs_mlp *mlp = &f->mlp[i];
        size_t n = mlp->n;
        if (i == ADCGS_P_ETA_PRIOR)
            n = 2u * f->params.n_eta;
        if (i == ADCGS_P_STEP)
            n = (size_t)f->params.n_fv + f->params.n_fg + (size_t)adcgs_sigma_rows(&f->params) + ADCGS_COLOUR_N;
        ADCGS_TRY(param_alloc(&f->param[i], n, error));
        if (!mlp->n)
            continue;
        ADCGS_TRY(adcgs_mlp_alloc(mlp, error));
        const int from_zero = i == ADCGS_P_OMEGA || i == ADCGS_P_VARPI || i == ADCGS_P_E_STEPS;
        adcgs_mlp_start(mlp, f->param[i].p, i == ADCGS_P_THETA ? 1.0f : from_zero ? 0.0f : ENTROPY_START, seed, (uint64_t)i);
    }
    start_time_table(f);
    const adcgs_mlp *theta = &f->mlp[ADCGS_P_THETA];
    float *b = f->param[ADCGS_P_THETA].p + theta->b[theta->hidden];
    b[13] = OPACITY_START;
    return ADCGS_OK;
}

/* ---- Anchors ---- */

static float first_step(const adcgs_fmodel *f, int group)
{
    const float step[ADCGS_P_ANCHOR] = {f->shape.step_fv, f->shape.step_fg, f->shape.step_sigma, f->shape.step_colour, 1.0f};
    return step[group];
}

static void start_steps(adcgs_fmodel *f)
{
    for (int i = 0; i < ADCGS_P_ETA; i++)
        for (int r = 0; r < adcgs_fmodel_rows(f, i); r++)
            f->param[ADCGS_P_STEP].p[adcgs_fmodel_step_at(f, i, r)] = logf(first_step(f, i));
    for (int r = 0; r < f->params.n_eta; r++)
        f->step[ADCGS_P_ETA][r] = first_step(f, ADCGS_P_ETA);
    adcgs_fmodel_take_steps(f);
}

/** Number of rows of a group with their own steps. */
static int channels_of(const adcgs_fmodel *f, int group)
{
    return group == ADCGS_P_FG ? f->params.n_fg : adcgs_fmodel_rows(f, group);
}

float adcgs_fmodel_finest_step(const adcgs_fmodel *f, int group, int channel)
{
    float most = STEP_LEAST;
    for (int r = channel; r < adcgs_fmodel_rows(f, group); r += channels_of(f, group))
        for (uint32_t i = 0; i < f->n; i++)
            most = fmaxf(most, fabsf(*adcgs_fmodel_at(f, group, i, r)));
    return most / LEVELS_USED;
}

void adcgs_fmodel_widen_steps(adcgs_fmodel *f)
{
    if (f->follows)
        return;
    for (int i = 0; i < ADCGS_P_ETA; i++)
        for (int c = 0; c < channels_of(f, i); c++) {
            float *log_step = &f->param[ADCGS_P_STEP].p[adcgs_fmodel_step_at(f, i, c)];
            *log_step = fmaxf(*log_step, logf(adcgs_fmodel_finest_step(f, i, c)));
        }
    adcgs_fmodel_take_steps(f);
}

void adcgs_fmodel_take_steps(adcgs_fmodel *f)
{
    if (f->follows) /* equal to the previous segment's, to the bit */
        return;
    const float reach = logf(STEP_REACH);
    for (int i = 0; i < ADCGS_P_ETA; i++) {
        const float middle = logf(first_step(f, i));
        for (int r = 0; r < adcgs_fmodel_rows(f, i); r++) {
            float *log_step = &f->param[ADCGS_P_STEP].p[adcgs_fmodel_step_at(f, i, r)];
            *log_step = fminf(fmaxf(*log_step, middle - reach), middle + reach);
            f->step[i][r] = expf(*log_step);
        }
    }
}

static adcgs_status alloc_anchors(adcgs_fmodel *f, uint32_t n, adcgs_error *error)
{
    const size_t groups = adcgs_lane_groups(n);
    f->n = n;
    f->groups = (uint32_t)groups;
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        f->param[i].p = NULL; /* the caller frees the old arrays */
    f->pos = adcgs_alloc(NULL, n, sizeof *f->pos, error);
    f->x = adcgs_alloc(NULL, groups * 3 * ADCGS_LANES, sizeof(float), error);
    f->code = adcgs_alloc(NULL, groups * ADCGS_LANES * 6 * (size_t)(f->params.octaves + 1), sizeof(float), error);
    f->keep = adcgs_alloc(NULL, groups * f->params.k * ADCGS_LANES, sizeof(float), error);
    f->moving = adcgs_alloc(NULL, groups * ADCGS_LANES, sizeof(float), error);
    f->live = adcgs_alloc(NULL, groups * ADCGS_LANES, sizeof(float), error);
    f->trainable = adcgs_alloc(NULL, groups * ADCGS_LANES, sizeof(float), error);
    f->body = adcgs_alloc(NULL, groups * ADCGS_LANES, 1, error);
    f->tier = adcgs_alloc(NULL, groups * ADCGS_LANES, 1, error);
    if (!f->pos || !f->x || !f->code || !f->keep || !f->moving || !f->live || !f->trainable || !f->body || !f->tier)
        return adcgs_alloc_status(error);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        ADCGS_TRY(param_alloc(&f->param[i], groups * (size_t)adcgs_fmodel_rows(f, i) * ADCGS_LANES, error));
    for (size_t i = 0; i < groups * ADCGS_LANES; i++)
        f->trainable[i] = 1;
    return ADCGS_OK;
}

/** Sets the values that follow from the voxels: positions, position codes, padding. */
static void place_anchors(adcgs_fmodel *f, const uint32_t (*pos)[3])
{
    memcpy(f->pos, pos, f->n * sizeof *f->pos);
    const float unit = ldexpf(1, -f->shape.depth - 1);
    for (uint32_t g = 0; g < f->groups; g++) {
        float cube[3][ADCGS_LANES] __attribute__((aligned(ADCGS_LANES)));
        for (uint32_t l = 0; l < ADCGS_LANES; l++) {
            const uint32_t i = g * ADCGS_LANES + l < f->n ? g * ADCGS_LANES + l : f->n - 1;
            for (int a = 0; a < 3; a++) {
                const float odd = (float)(2 * pos[i][a] + 1);
                f->x[((size_t)g * 3 + (size_t)a) * ADCGS_LANES + l] = fmaf(odd, 0.5f * f->voxel, f->origin[a]);
                cube[a][l] = odd * unit;
            }
            f->live[g * ADCGS_LANES + l] = g * ADCGS_LANES + l < f->n ? 1.0f : 0.0f;
        }
        adcgs_position_code(f->code + (size_t)g * 6 * f->params.octaves * ADCGS_LANES, &cube[0][0], f->params.octaves);
    }
}

adcgs_status adcgs_fmodel_create(adcgs_fmodel **out, const adcgs_params *params, const adcgs_shape *shape, const float origin[3],
                                 float voxel, const uint32_t (*pos)[3], uint32_t n, uint64_t seed, adcgs_error *error)
{
    adcgs_fmodel *f = adcgs_alloc(NULL, 1, sizeof *f, error);
    *out = NULL;
    if (!f)
        return adcgs_alloc_status(error);
    f->params = *params;
    f->shape = *shape;
    memcpy(f->origin, origin, sizeof f->origin);
    f->voxel = voxel;
    layout_networks(f);
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        f->param[i].name = names[i];
    adcgs_status status = create_networks(f, seed, error);
    for (int i = 0; status == ADCGS_OK && i < ADCGS_P_ANCHOR; i++) {
        f->step[i] = adcgs_alloc(NULL, (size_t)adcgs_fmodel_rows(f, i) + 1, sizeof(float), error);
        status = f->step[i] ? ADCGS_OK : adcgs_alloc_status(error);
    }
    if (status == ADCGS_OK)
        status = alloc_anchors(f, n, error);
    if (status != ADCGS_OK) {
        adcgs_fmodel_free(&f);
        return status;
    }
    start_steps(f);
    place_anchors(f, pos);
    for (size_t i = 0; i < (size_t)f->groups * ADCGS_LANES; i++) {
        f->moving[i] = params->time_rows ? f->live[i] : 0;
        for (int k = 0; k < params->k; k++)
            f->keep[(i / ADCGS_LANES * params->k + (size_t)k) * ADCGS_LANES + i % ADCGS_LANES] = f->live[i];
    }
    for (size_t i = 0; i < f->param[ADCGS_P_FV].n; i++)
        f->param[ADCGS_P_FV].p[i] = (float)(FV_START * adcgs_random_normal(seed, ADCGS_P_FV, i));
    for (size_t i = 0; params->spans && i < (size_t)f->groups * ADCGS_LANES; i++)
        f->param[ADCGS_P_SIGMA].p[(i / ADCGS_LANES * ADCGS_SIGMA_MAX + ADCGS_SPAN_PACE) * ADCGS_LANES + i % ADCGS_LANES] =
            ADCGS_SPAN_WHOLE;
    *out = f;
    return ADCGS_OK;
}

static void free_anchors(adcgs_fmodel *f)
{
    adcgs_free(NULL, f->pos);
    adcgs_free(NULL, f->x);
    adcgs_free(NULL, f->code);
    adcgs_free(NULL, f->keep);
    adcgs_free(NULL, f->moving);
    adcgs_free(NULL, f->live);
    adcgs_free(NULL, f->trainable);
    adcgs_free(NULL, f->body);
    adcgs_free(NULL, f->tier);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        adcgs_free(NULL, f->param[i].p);
}

void adcgs_fmodel_free(adcgs_fmodel **model)
{
    adcgs_fmodel *f = *model;
    if (!f)
        return;
    free_anchors(f);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        adcgs_free(NULL, f->step[i]);
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        adcgs_free(NULL, f->param[i].p);
        adcgs_mlp_clear(&f->mlp[i]);
    }
    adcgs_free(NULL, f);
    *model = NULL;
}

/** Copies anchor `from` of the old array to anchor `to` of the new one, with `rows` features each. */
static void copy_rows(float *to_array, const float *from_array, uint32_t to, uint32_t from, size_t rows)
{
    float *t = to_array + (size_t)(to / ADCGS_LANES) * rows * ADCGS_LANES + to % ADCGS_LANES;
    const float *s = from_array + (size_t)(from / ADCGS_LANES) * rows * ADCGS_LANES + from % ADCGS_LANES;
    for (size_t r = 0; r < rows; r++)
        t[r * ADCGS_LANES] = s[r * ADCGS_LANES];
}

adcgs_status adcgs_fmodel_regroup(adcgs_fmodel *f, const uint32_t (*pos)[3], const uint32_t *source, const uint8_t *fresh,
                                  uint32_t n, adcgs_error *error)
{
    adcgs_fmodel old = *f;
    adcgs_status status = alloc_anchors(f, n, error);
    if (status != ADCGS_OK) {
        free_anchors(f);
        *f = old;
        return status;
    }
    place_anchors(f, pos);
    for (uint32_t j = 0; j < n; j++) {
        for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
            const size_t rows = (size_t)adcgs_fmodel_rows(f, i);
            copy_rows(f->param[i].p, old.param[i].p, j, source[j], rows);
            if (!fresh || !fresh[j]) {
                copy_rows(f->param[i].m, old.param[i].m, j, source[j], rows);
                copy_rows(f->param[i].v, old.param[i].v, j, source[j], rows);
            }
        }
        if (!fresh || !fresh[j])
            copy_rows(f->trainable, old.trainable, j, source[j], 1);
        copy_rows(f->keep, old.keep, j, source[j], f->params.k);
        copy_rows(f->moving, old.moving, j, source[j], 1);
        f->body[j] = old.body[source[j]];
        f->tier[j] = fresh && fresh[j] ? 0 : old.tier[source[j]];
    }
    free_anchors(&old);
    return ADCGS_OK;
}

adcgs_time_rows adcgs_fmodel_time_rows(const adcgs_params *params, float t)
{
    const uint32_t rows = params->time_rows;
    if (rows < 2)
        return (adcgs_time_rows){0, 1, {1}};
    const adcgs_time_place at = adcgs_time_place_of(t, rows);
    if (!params->smooth_time)
        return (adcgs_time_rows){(int)at.row, 2, {1 - at.fraction, at.fraction}};
    const float *w = at.weight;
    const int before = at.row > 0, behind = at.row + 2 < rows;
    /* A missing row is extrapolated: twice its neighbour minus the row beyond it. */
    const float b = w[1] + (before ? 0 : 2 * w[0]) - (behind ? 0 : w[3]);
    const float c = w[2] + (behind ? 0 : 2 * w[3]) - (before ? 0 : w[0]);
    return before ? (adcgs_time_rows){(int)at.row - 1, 3 + behind, {w[0], b, c, w[3]}}
                  : (adcgs_time_rows){0, 2 + behind, {b, c, w[3]}};
}

float adcgs_fmodel_presence(const adcgs_fmodel *f, uint32_t anchor, float t)
{
    if (!f->params.spans || f->moving[anchor] == 0)
        return 1;
    const float middle = *adcgs_fmodel_at(f, ADCGS_P_SIGMA, anchor, ADCGS_SPAN_MIDDLE) * 0.125f + 0.5f;
    const float pace = expf(adcgs_clampf(*adcgs_fmodel_at(f, ADCGS_P_SIGMA, anchor, ADCGS_SPAN_PACE), -8, 8));
    const float u = adcgs_clampf((t - middle) * pace, -4, 4);
    return expf(-u * u * u * u);
}
