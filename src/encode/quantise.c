/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Float model to adcgs_model. */
#include "encode/quantise.h"

#include <math.h>

/* ---- Networks ---- */

/** Fraction bits of an entropy network's weights, and of its inputs and hidden activations (units of 16 steps). */
enum { E24_WEIGHT_BITS = 6, E24_ACTIVATION_BITS = 6, E24_INPUT_SHIFT = 4 };

static adcgs_status tensor_alloc(adcgs_tensor *t, uint32_t rows, uint32_t cols, int e, adcgs_error *error)
{
    t->rows = rows;
    t->cols = cols;
    t->mode = 0;
    t->e = (uint8_t)e;
    t->m = adcgs_alloc(NULL, (size_t)rows * cols, sizeof *t->m, error);
    return t->m ? ADCGS_OK : ADCGS_ERR_MEMORY;
}

static void tensor_set(adcgs_tensor *t, const float *w, double scale, int32_t limit)
{
    for (size_t i = 0; i < (size_t)t->rows * t->cols; i++) {
        const double v = rint((double)w[i] * scale);
        /* NaN, of a training run about to be rolled back, becomes the lower limit: its conversion is undefined. */
        t->m[i] = (int32_t)(v > -limit ? ADCGS_MIN(v, limit) : -limit);
    }
}

/** Keep A*sum|w| + |b| + rounding inside 2^24 by shrinking the row: never needed by networks that trained normally. */
static void bound_row(adcgs_layer *layer, uint32_t row, int shift)
{
    int32_t *w = layer->w.m + (size_t)row * layer->w.cols, *b = &layer->b.m[row];
    for (;;) {
        int64_t sum = 0;
        for (uint32_t i = 0; i < layer->w.cols; i++)
            sum += w[i] < 0 ? -(int64_t)w[i] : w[i];
        if (2047 * sum + (*b < 0 ? -(int64_t)*b : *b) + ((int64_t)1 << shift) < (1 << 24))
            return;
        for (uint32_t i = 0; i < layer->w.cols; i++)
            w[i] /= 2;
        *b /= 2;
    }
}

/** The integer form of an entropy network; its float twin is rate.c's, in units of the gains of train/dsp.h. */
static adcgs_status entropy_network(adcgs_net *net, const adcgs_mlp *m, const float *p, int role, adcgs_error *error)
{
    const int unit = E24_WEIGHT_BITS + E24_ACTIVATION_BITS;
    net->present = 1;
    net->role = (uint8_t)role;
    net->n_layers = (uint8_t)(m->hidden + 1);
    net->in_shift = E24_INPUT_SHIFT;
    for (int i = 0; i <= m->hidden; i++) {
        adcgs_layer *layer = &net->layer[i];
        const int last = i == m->hidden;
        ADCGS_TRY(tensor_alloc(&layer->w, (uint32_t)m->n_out[i], (uint32_t)m->in[i], E24_WEIGHT_BITS, error));
        ADCGS_TRY(tensor_alloc(&layer->b, (uint32_t)m->n_out[i], 1, 0, error));
        tensor_set(&layer->w, p + m->w[i], ldexp(1, E24_WEIGHT_BITS), 2047);
        /* Biases live at the accumulators' scale; on the weights' lattice their low bits are zero and cost nothing. */
        tensor_set(&layer->b, p + m->b[i], ldexp(1, E24_WEIGHT_BITS), 1 << 14);
        for (uint32_t j = 0; j < layer->b.rows; j++)
            layer->b.m[j] *= 1 << E24_ACTIVATION_BITS;
        layer->residual = (uint8_t)(i > 0 && !last);
        /* Hidden: back to activation bits. Output mu: gain 16 (2^4) in 1/64 step (2^6). */
        layer->shift = (uint8_t)(last ? unit - 10 : E24_WEIGHT_BITS);
        for (uint32_t j = 0; j < layer->w.rows; j++)
            bound_row(layer, j, unit - 3);
    }
    net->sigma_shift = (uint8_t)(unit - 3); /* gain 8 */
    net->sigma_offset = (int16_t)ADCGS_SI_CENTRE;
    return ADCGS_OK;
}

static adcgs_status float_network(adcgs_net *net, const adcgs_mlp *m, const float *p, int role, adcgs_error *error)
{
    net->present = 1;
    net->role = (uint8_t)role;
    net->n_layers = (uint8_t)(m->hidden + 1);
    for (int i = 0; i <= m->hidden; i++) {
        adcgs_layer *layer = &net->layer[i];
        const int e = m->lattice[i] == 127 ? 12 : m->lattice[i];
        const int32_t limit = ADCGS_MIN((1 << 24) - 1, (1 << (e + 8)) - 1);
        const size_t biases = (i < m->hidden ? m->w[i + 1] : m->n) - m->b[i];
        ADCGS_TRY(tensor_alloc(&layer->w, (uint32_t)m->n_out[i], (uint32_t)m->in[i], e, error));
        ADCGS_TRY(tensor_alloc(&layer->b, (uint32_t)biases, 1, e, error));
        tensor_set(&layer->w, p + m->w[i], ldexp(1, e), limit);
        tensor_set(&layer->b, p + m->b[i], ldexp(1, e), limit);
        layer->residual = i > 0 && i < m->hidden;
    }
    return ADCGS_OK;
}

static adcgs_status set_networks(adcgs_model *model, const adcgs_fmodel *f, adcgs_error *error)
{
    static const uint8_t roles[ADCGS_P_COUNT] = {
        [ADCGS_P_THETA] = ADCGS_ROLE_PREDICTION, [ADCGS_P_OMEGA] = ADCGS_ROLE_COARSE,       [ADCGS_P_VARPI] = ADCGS_ROLE_FINE,
        [ADCGS_P_TIME] = ADCGS_ROLE_TIME,        [ADCGS_P_E_FV] = ADCGS_ROLE_ENTROPY_FV,
        [ADCGS_P_E_SIGMA] = ADCGS_ROLE_ENTROPY_SIGMA, [ADCGS_P_E_COLOUR] = ADCGS_ROLE_ENTROPY_COLOUR,
        [ADCGS_P_E_FG] = ADCGS_ROLE_ENTROPY_FG, [ADCGS_P_E_FG + 1] = ADCGS_ROLE_ENTROPY_FG + 1,
        [ADCGS_P_E_FG + 2] = ADCGS_ROLE_ENTROPY_FG + 2, [ADCGS_P_E_FG + 3] = ADCGS_ROLE_ENTROPY_FG + 3,
    };
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        const int deforms = i == ADCGS_P_OMEGA || i == ADCGS_P_VARPI || i == ADCGS_P_TIME;
        if (!f->mlp[i].n || (deforms && !model->params.time_rows))
            continue;
        adcgs_net *net = &model->net[roles[i]];
        if (i >= ADCGS_P_E_FV)
            ADCGS_TRY(entropy_network(net, &f->mlp[i], f->param[i].p, roles[i], error));
        else
            ADCGS_TRY(float_network(net, &f->mlp[i], f->param[i].p, roles[i], error));
    }
    return ADCGS_OK;
}

/* ---- Anchors ---- */

static void set_anchors(adcgs_model *model, const adcgs_fmodel *f)
{
    for (uint32_t i = 0; i < f->n; i++) {
        memcpy(model->pos + (size_t)i * 3, f->pos[i], sizeof f->pos[i]);
        model->is_static[i] = model->params.time_rows && f->moving[i] == 0;
        model->mask[i] = 0;
        for (int k = 0; k < f->params.k; k++)
            if (f->keep[adcgs_fmodel_slot(f, i, k)] != 0)
                model->mask[i] |= (uint16_t)(1u << k);
    }
}

static void set_steps(adcgs_model *model, const adcgs_fmodel *f)
{
    float *const d[4] = { model->d_fv, model->d_fg, model->d_sigma, model->d_colour };
    const int rows[4] = { f->params.n_fv, f->params.n_fg, ADCGS_SIGMA_N, ADCGS_COLOUR_N };
    for (int i = 0; i < 4; i++)
        for (int r = 0; r < rows[i]; r++)
            d[i][r] = f->step[i][r] * 0x1p-6f;
    const float *prior = f->param[ADCGS_P_ETA_PRIOR].p;
    for (int i = 0; i < f->params.n_eta; i++) {
        const double si = rint(ADCGS_SI_GAIN * prior[f->params.n_eta + i] + ADCGS_SI_CENTRE);
        model->eta_mu[i] = (int16_t)rint(fmin(fmax(64 * ADCGS_MU_GAIN * prior[i], -4096), 4096));
        model->eta_si[i] = (uint8_t)fmin(fmax(si, 0), 63);
    }
}

/* ---- Latents ---- */

typedef struct quantiser {
    const adcgs_fmodel *f;
    const adcgs_model *model;
    float *const *mu, *const *value;
} quantiser;

static void quantise_site(void *user, const adcgs_latent_site *s)
{
    const quantiser *q = user;
    const adcgs_fmodel *f = q->f;
    static const int groups[ADCGS_GROUP_FG] = { ADCGS_P_ETA, ADCGS_P_FV, ADCGS_P_SIGMA, ADCGS_P_COLOUR };
    const int group = s->group >= ADCGS_GROUP_FG ? ADCGS_P_FG : groups[s->group];
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    const int base = group == ADCGS_P_FG ? s->k * f->params.n_fg : 0;
    for (int c = 0; c < s->count; c++) {
        const int row = base + s->first + c;
        const size_t at = ((size_t)(s->anchor / 64) * rows + (size_t)row) * 64 + s->anchor % 64;
        const double target = 64.0 * f->param[group].p[at] / f->step[group][row];
        const int32_t mu = s->mu[c], most = s->si[c] ? ADCGS_MIN(adcgs_value_max(q->model->shape[s->group], s->si[c]), 500) : 0;
        double n = rint((target - mu) / 64);
        n = n >= most ? most : n >= -most ? n : -most; /* whatever n is, a value within reach */
        s->yq[c] = (int16_t)adcgs_clip(64 * (int32_t)n + mu, 32767);
        if (q->mu)
            q->mu[group][at] = (float)mu;
        if (q->value)
            q->value[group][at] = (float)s->yq[c] * (f->step[group][row] * 0x1p-6f);
    }
}

/** Where nothing moves, a stream carries no motion: no networks, no time table, no flags. */
static int moves(const adcgs_fmodel *f)
{
    for (uint32_t i = 0; i < f->n; i++)
        if (f->moving[i] != 0)
            return 1;
    return 0;
}

adcgs_status adcgs_quantise(adcgs_model *model, const adcgs_fmodel *f, adcgs_cpu_level cpu, float *const mu[ADCGS_P_ANCHOR],
                            float *const value[ADCGS_P_ANCHOR], adcgs_error *error)
{
    memset(model, 0, sizeof *model);
    model->params = f->params;
    if (!moves(f))
        model->params.time_rows = model->params.time_width = 0;
    model->n = f->n;
    model->depth = (uint8_t)f->shape.depth;
    memcpy(model->origin, f->origin, sizeof model->origin);
    model->voxel = f->voxel;
    model->layers = (uint8_t)(1 + f->params.chunks);
    ADCGS_TRY(adcgs_model_alloc(model, NULL, error));
    set_anchors(model, f);
    set_steps(model, f);
    ADCGS_TRY(set_networks(model, f, error));
    adcgs_latents *latents;
    ADCGS_TRY(adcgs_latents_create(&latents, model, cpu, NULL, error));
    quantiser q = { f, model, mu, value };
    adcgs_status status = ADCGS_OK;
    for (int layer = 0; status == ADCGS_OK && layer <= f->params.chunks; layer++)
        status = adcgs_latents_walk(latents, model, layer, 0, model->n, quantise_site, &q);
    adcgs_latents_free(&latents);
    return status;
}
