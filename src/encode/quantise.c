/* SPDX-License-Identifier: BSD-2-Clause */
/** \file From the float model to adcgs_model. */
#include "encode/quantise.h"

#include "encode/rdo.h"
#include "model/model_priv.h"
#include "splat/steps.h"

#include <math.h>

/* ---- Networks ---- */

/** The largest binary32 below 2^8, the bound of weights of binary32 networks; definition of the format. */
#define FLOAT_WEIGHT_MAX 0x1.fffffep7f

static adcgs_status tensor_alloc(adcgs_tensor *t, uint32_t rows, uint32_t cols, int e, adcgs_error *error)
{
    t->rows = rows;
    t->cols = cols;
    t->mode = 0;
    t->e = (uint8_t)e;
    t->m = adcgs_alloc(NULL, (size_t)rows * cols, sizeof *t->m, error);
    return t->m ? ADCGS_OK : adcgs_alloc_status(error);
}

static void tensor_set(adcgs_tensor *t, const float *w, double scale, int32_t limit)
{
    for (size_t i = 0; i < (size_t)t->rows * t->cols; i++) {
        const double v = rint((double)w[i] * scale);
        /* NaN, of a training run about to be rolled back, becomes the lower limit: its conversion is undefined. */
        t->m[i] = (int32_t)(v > -limit ? ADCGS_MIN(v, limit) : -limit);
    }
}

/** Stores the numbers' own bits if there is no lattice, within the range of networks: no subnormals, magnitudes below 2^8. */
static void tensor_set_exact(adcgs_tensor *t, const float *w)
{
    t->mode = 1;
    for (size_t i = 0; i < (size_t)t->rows * t->cols; i++) {
        const float v = adcgs_bounded(w[i], -FLOAT_WEIGHT_MAX, FLOAT_WEIGHT_MAX);
        t->m[i] = (int32_t)adcgs_float_bits(fabsf(v) < 0x1p-126f ? 0 : v);
    }
}

/** Makes the integer form of an entropy network. weights: the trained network's on the lattice, from adcgs_mlp_integer(). */
static adcgs_status entropy_network(adcgs_net *net, const adcgs_mlp *m, const float *weights, int role, adcgs_error *error)
{
    const int one = 1 << ADCGS_E24_BITS, prior = adcgs_role_is_prior(role);
    net->present = 1;
    net->role = (uint8_t)role;
    net->n_layers = (uint8_t)(m->hidden + 1);
    net->in_shift = ADCGS_E24_INPUT_SHIFT;
    for (int i = 0; i <= m->hidden; i++) {
        adcgs_layer *layer = &net->layer[i];
        const int last = i == m->hidden;
        ADCGS_TRY(tensor_alloc(&layer->w, (uint32_t)m->n_out[i], (uint32_t)m->in[i], ADCGS_E24_BITS, error));
        ADCGS_TRY(tensor_alloc(&layer->b, (uint32_t)m->n_out[i], 1, 0, error));
        tensor_set(&layer->w, weights + m->w[i], one, ADCGS_E24_MAX);
        /* Biases have the accumulators' scale; on the weights' lattice their low bits are zero and cost nothing. */
        tensor_set(&layer->b, weights + m->b[i], (double)one * one, (1 << 24) - 1);
        layer->residual = (uint8_t)(i > 0 && !last);
        /* Hidden: back to the activations' lattice. Output mu: gain 16 (2^4) in 1/64 step (2^6). Output q: gain 8. */
        layer->shift = (uint8_t)(!last ? ADCGS_E24_BITS : 2 * ADCGS_E24_BITS - (prior ? 10 : 3));
    }
    net->sigma_shift = (uint8_t)(prior ? 2 * ADCGS_E24_BITS - 3 : 0); /* gain 8 */
    net->sigma_offset = (int16_t)(prior ? ADCGS_SI_CENTRE : 0);
    return ADCGS_OK;
}

/** Removes the means and scales of channels after the first `rows` from the last layer. */
static void cut_channels(adcgs_mlp *m, float *weights, int rows)
{
    const int last = m->hidden, all = m->n_out[last] / 2;
    const size_t in = (size_t)m->in[last], n = (size_t)rows;
    float *w = weights + m->w[last], *b = weights + m->b[last];
    memmove(w + n * in, w + (size_t)all * in, n * in * sizeof *w);
    memmove(b + n, b + all, n * sizeof *b);
    m->n_out[last] = 2 * rows;
}

static adcgs_status integer_network(adcgs_net *net, const adcgs_mlp *twin, const float *p, int role, int outputs,
                                    adcgs_error *error)
{
    adcgs_mlp m = *twin;
    float *weights = adcgs_alloc(NULL, m.n, sizeof *weights, error);
    if (!weights)
        return adcgs_alloc_status(error);
    adcgs_mlp_integer(&m, p, weights);
    if (outputs < m.n_out[m.hidden])
        cut_channels(&m, weights, outputs / 2);
    const adcgs_status status = entropy_network(net, &m, weights, role, error);
    adcgs_free(NULL, weights);
    return status;
}

static adcgs_status float_network(adcgs_net *net, const adcgs_mlp *m, const float *p, int role, adcgs_error *error)
{
    net->present = 1;
    net->role = (uint8_t)role;
    net->n_layers = (uint8_t)(m->hidden + 1);
    for (int i = 0; i <= m->hidden; i++) {
        adcgs_layer *layer = &net->layer[i];
        const int exact = m->weight_step[i] == ADCGS_WEIGHT_STEP_NONE, e = exact ? 0 : m->weight_step[i];
        const int32_t limit = (int32_t)ldexpf(FLOAT_WEIGHT_MAX, ADCGS_MIN(e, 16));
        const size_t biases = (i < m->hidden ? m->w[i + 1] : m->n) - m->b[i];
        ADCGS_TRY(tensor_alloc(&layer->w, (uint32_t)m->n_out[i], (uint32_t)m->in[i], e, error));
        ADCGS_TRY(tensor_alloc(&layer->b, (uint32_t)biases, 1, e, error));
        if (exact) {
            tensor_set_exact(&layer->w, p + m->w[i]);
            tensor_set_exact(&layer->b, p + m->b[i]);
        } else {
            tensor_set(&layer->w, p + m->w[i], ldexp(1, e), limit);
            tensor_set(&layer->b, p + m->b[i], ldexp(1, e), limit);
        }
        layer->residual = i > 0 && i < m->hidden;
    }
    return ADCGS_OK;
}

static adcgs_status set_networks(adcgs_model *model, const adcgs_fmodel *f, adcgs_error *error)
{
    const int still = !adcgs_fmodel_moves(f);
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        const int deforms = i == ADCGS_P_OMEGA || i == ADCGS_P_VARPI, timed = deforms || i == ADCGS_P_TIME;
        if (!f->mlp[i].n || (timed && !model->params.time_rows) || (deforms && still))
            continue;
        const int role = adcgs_fmodel_role[i];
        adcgs_net *net = &model->net[role];
        uint32_t n_in, n_out; /* fewer than in training if the model is static */
        adcgs_role_shape(&model->params, role, &n_in, &n_out);
        if (f->mlp[i].entropy)
            ADCGS_TRY(integer_network(net, &f->mlp[i], f->param[i].p, role, (int)n_out, error));
        else
            ADCGS_TRY(float_network(net, &f->mlp[i], f->param[i].p, role, error));
    }
    return ADCGS_OK;
}

/* ---- Anchors ---- */

static void set_anchors(adcgs_model *model, const adcgs_fmodel *f)
{
    for (uint32_t i = 0; i < f->n; i++) {
        memcpy(model->pos + (size_t)i * 3, f->pos[i], sizeof f->pos[i]);
        model->is_static[i] = model->params.time_rows && f->moving[i] == 0;
        model->body[i] = model->params.bodies && !model->is_static[i] ? f->body[i] : 0;
        model->tier[i] = f->tier[i];
        model->mask[i] = 0;
        for (int k = 0; k < f->params.k; k++)
            if (f->keep[adcgs_fmodel_slot(f, i, k)] != 0)
                model->mask[i] |= (uint16_t)(1u << k);
    }
}

/** Sets the tiers, or a single tier if one has lost all its anchors. */
static void set_tiers(adcgs_model *model, const adcgs_fmodel *f)
{
    uint32_t brings[ADCGS_TIERS_MAX] = {0};
    model->finest = f->finest;
    memcpy(model->growth, f->growth, sizeof model->growth);
    for (uint32_t i = 0; i < model->n; i++)
        brings[model->tier[i]]++;
    for (int t = 0; t <= f->finest; t++)
        if (!brings[t])
            model->finest = 0;
    if (!model->finest)
        memset(model->tier, 0, model->n);
}

static void set_steps(adcgs_model *model, const adcgs_fmodel *f)
{
    float *const d[4] = {model->d_fv, model->d_fg, model->d_sigma, model->d_colour};
    const int rows[4] = {f->params.n_fv, f->params.n_fg, adcgs_sigma_rows(&model->params), ADCGS_COLOUR_N};
    for (int i = 0; i < 4; i++)
        for (int r = 0; r < rows[i]; r++)
            d[i][r] = f->step[i][r] * 0x1p-6f;
    const float *prior = f->param[ADCGS_P_ETA_PRIOR].p;
    for (int i = 0; i < f->params.n_eta; i++) {
        model->eta_mu[i] = (int16_t)adcgs_coder_mean(prior[i]);
        model->eta_si[i] = (uint8_t)adcgs_coder_level(prior[f->params.n_eta + i]);
    }
}

/* ---- Latents ---- */

typedef struct quantiser {
    const adcgs_fmodel *f;
    const adcgs_model *model;
    const adcgs_quantise_options *o;
    adcgs_steps steps;
    float (*factor)[ADCGS_LANES]; /**< [groups * steps.n] */
    void *scratch;                /**< scratch memory of steps */
} quantiser;

/** The factor of a site's steps. The factors of 64 anchors follow from their f_v, which is final when Sigma_v begins. */
static float factor_of(const quantiser *q, const adcgs_latent_site *s)
{
    if (!q->steps.n || s->group < ADCGS_GROUP_SIGMA)
        return 1;
    float(*factor)[ADCGS_LANES] = q->factor + (size_t)(s->anchor / ADCGS_LANES) * (size_t)q->steps.n;
    if (s->group == ADCGS_GROUP_SIGMA && s->anchor % ADCGS_LANES == 0)
        adcgs_steps_factors(&q->steps, q->model, s->anchor, factor, q->scratch);
    return factor[adcgs_group_steps(s->group)][s->anchor % ADCGS_LANES];
}

static void quantise_site(void *user, const adcgs_latent_site *s)
{
    const quantiser *q = user;
    const adcgs_fmodel *f = q->f;
    static const int groups[ADCGS_GROUP_FG] = {ADCGS_P_ETA, ADCGS_P_FV, ADCGS_P_SIGMA, ADCGS_P_COLOUR};
    const int group = s->group >= ADCGS_GROUP_FG ? ADCGS_P_FG : groups[s->group];
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    const int base = group == ADCGS_P_FG ? s->k * f->params.n_fg : 0;
    const float *target = q->o->rdo ? q->o->rdo->target[group] : f->param[group].p;
    const float factor = factor_of(q, s);
    const float *curvature = q->o->rdo ? q->o->rdo->curvature[group] : NULL;
    for (int c = 0; c < s->count; c++) {
        const int row = base + s->first + c;
        const size_t at = ((size_t)(s->anchor / ADCGS_LANES) * rows + (size_t)row) * ADCGS_LANES + s->anchor % ADCGS_LANES;
        const float d = f->step[group][row] * 0x1p-6f * factor, step = 64 * d;
        const int32_t mu = s->mu[c], most = s->si[c] ? ADCGS_LEVEL_MAX : 0; /* codable at every level except 0 */
        const double wanted = (64.0 * target[at] / step - mu) / 64;
        double n = rint(wanted);
        n = n >= most ? most : n >= -most ? n : -most; /* keeps the value in range for any n */
        if (curvature)
            n = adcgs_rdo_level(s->si[c], wanted, (int32_t)n, 0.5 * curvature[at] * step * step, q->o->rdo->lambda_bit);
        s->yq[c] = (int16_t)adcgs_clip(64 * (int32_t)n + mu, 32767);
        if (q->o->mu)
            q->o->mu[group][at] = adcgs_mean_pack((float)mu, most == 0);
        if (q->o->value)
            q->o->value[group][at] = (float)s->yq[c] * d;
    }
}

/** Quantises all latents of the model along the walk that defines their order. */
static adcgs_status walk_latents(quantiser *q, adcgs_model *model, adcgs_error *error)
{
    adcgs_latents *latents;
    ADCGS_TRY(adcgs_latents_create(&latents, model, q->o->cpu, NULL, error));
    adcgs_status status = ADCGS_OK;
    for (int layer = 0; status == ADCGS_OK && layer < model->layers; layer++)
        status = adcgs_latents_walk(latents, model, layer, 0, model->n, quantise_site, q, error);
    adcgs_latents_free(&latents);
    return status;
}

static adcgs_status quantise_latents(adcgs_model *model, const adcgs_fmodel *f, const adcgs_quantise_options *options,
                                     adcgs_error *error)
{
    quantiser q = {.f = f, .model = model, .o = options};
    ADCGS_TRY(adcgs_steps_init(&q.steps, model, options->cpu, NULL, error));
    const size_t factors = (size_t)f->groups * (size_t)q.steps.n * ADCGS_LANES;
    float *own = options->factor ? NULL : adcgs_alloc(NULL, factors, sizeof *own, error);
    q.factor = (float(*)[ADCGS_LANES])(options->factor ? options->factor : own);
    q.scratch = adcgs_alloc(NULL, adcgs_steps_scratch(&q.steps), 1, error);
    const adcgs_status status = q.factor && q.scratch ? walk_latents(&q, model, error) : adcgs_alloc_status(error);
    adcgs_free(NULL, own);
    adcgs_free(NULL, q.scratch);
    adcgs_steps_clear(&q.steps, NULL);
    return status;
}

adcgs_status adcgs_quantise(adcgs_model *model, const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error)
{
    memset(model, 0, sizeof *model);
    model->params = f->params;
    /* A static stream of one segment carries no motion: no networks, no time table, no flags. */
    if (!f->is_part && !adcgs_fmodel_moves(f)) {
        model->params.time_rows = model->params.time_width = 0;
        model->params.spans = model->params.bodies = model->params.smooth_time = 0;
    }
    model->n = f->n;
    model->depth = (uint8_t)f->shape.depth;
    memcpy(model->origin, f->origin, sizeof model->origin);
    model->voxel = f->voxel;
    model->layers = (uint8_t)adcgs_params_layers(&f->params);
    ADCGS_TRY(adcgs_model_alloc(model, NULL, error));
    set_anchors(model, f);
    set_tiers(model, f);
    set_steps(model, f);
    ADCGS_TRY(set_networks(model, f, error));
    return quantise_latents(model, f, options, error);
}
