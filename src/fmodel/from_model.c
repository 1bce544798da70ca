/* SPDX-License-Identifier: BSD-2-Clause */
/** \file From adcgs_model to the float model. */
#include "fmodel/from_model.h"

#include "fmodel/body_trajectories.h"
#include "splat/steps.h"

#include <math.h>

int adcgs_fmodel_is_settled(const adcgs_fmodel *f, int group)
{
    return f->follows && (group == ADCGS_P_THETA || group == ADCGS_P_ETA_PRIOR || group == ADCGS_P_STEP || group >= ADCGS_P_E_FV);
}

/* ---- Networks ---- */

static float number_of(const adcgs_tensor *t, size_t i, int scale)
{
    return t->mode ? adcgs_bits_float((uint32_t)t->m[i]) : ldexpf((float)t->m[i], -scale);
}

static void take_layer(adcgs_mlp *m, float *p, const adcgs_net *net, int l)
{
    const adcgs_tensor *w = &net->layer[l].w, *b = &net->layer[l].b;
    const int weights = m->entropy ? ADCGS_E24_BITS : w->e, biases = m->entropy ? 2 * ADCGS_E24_BITS : b->e;
    for (size_t i = 0; i < (size_t)w->rows * w->cols; i++)
        p[m->w[l] + i] = number_of(w, i, weights);
    for (size_t i = 0; net->role != ADCGS_ROLE_TIME && i < b->rows; i++)
        p[m->b[l] + i] = number_of(b, i, biases);
    m->weight_step[l] = (int8_t)(m->entropy ? ADCGS_E24_BITS : w->mode ? ADCGS_WEIGHT_STEP_NONE : w->e);
}

static adcgs_status take_network(adcgs_fmodel *f, int group, const adcgs_net *net, adcgs_error *error)
{
    adcgs_mlp *m = &f->mlp[group];
    const int width = net->n_layers > 1 ? (int)net->layer[0].w.rows : m->width;
    int fits = m->hidden + 1 == net->n_layers && width <= m->width;
    if (fits && width < m->width)
        adcgs_fmodel_set_width(f, group, width);
    for (int l = 0; fits && l <= m->hidden; l++)
        fits = net->layer[l].w.rows == (uint32_t)m->n_out[l] && net->layer[l].w.cols == (uint32_t)m->in[l];
    if (!fits)
        return adcgs_fail(error, ADCGS_ERR_DATA, "the previous segment has networks of another shape");
    for (int l = 0; l <= m->hidden; l++)
        take_layer(m, f->param[group].p, net, l);
    return ADCGS_OK;
}

/** Takes the networks. Motion networks are absent if nothing has moved yet, and then keep their initial values. */
static adcgs_status take_networks(adcgs_fmodel *f, const adcgs_model *model, adcgs_error *error)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        if (f->mlp[i].n && model->net[adcgs_fmodel_role[i]].present)
            ADCGS_TRY(take_network(f, i, &model->net[adcgs_fmodel_role[i]], error));
    return ADCGS_OK;
}

/* ---- Anchors ---- */

static void take_steps(adcgs_fmodel *f, const adcgs_model *model)
{
    const float *const d[ADCGS_P_ETA] = {model->d_fv, model->d_fg, model->d_sigma, model->d_colour};
    for (int i = 0; i < ADCGS_P_ETA; i++)
        for (int r = 0; r < adcgs_fmodel_rows(f, i); r++) {
            f->step[i][r] = 64 * d[i][i == ADCGS_P_FG ? r % f->params.n_fg : r];
            f->param[ADCGS_P_STEP].p[adcgs_fmodel_step_at(f, i, r)] = logf(f->step[i][r]);
        }
    for (int i = 0; i < f->params.n_eta; i++) {
        f->param[ADCGS_P_ETA_PRIOR].p[i] = (float)model->eta_mu[i] / (64 * ADCGS_MU_GAIN);
        f->param[ADCGS_P_ETA_PRIOR].p[f->params.n_eta + i] = ((float)model->eta_si[i] - ADCGS_SI_CENTRE) / ADCGS_SI_GAIN;
    }
}

/** Takes the values of one anchor. factor: of the steps of Sigma_v, of C_v, and of the chunks of f_g. */
static void take_anchor(adcgs_fmodel *f, const adcgs_model *model, uint32_t a, const float *factor)
{
    const adcgs_params *p = &f->params;
    const int n_sigma = adcgs_sigma_rows(p), n_fg = p->n_fg, chunk = n_fg / p->chunks;
    const size_t i = a;
    for (int c = 0; c < p->n_eta; c++)
        *adcgs_fmodel_at(f, ADCGS_P_ETA, a, c) = (float)model->eta[i * p->n_eta + (size_t)c] * 0x1p-6f;
    for (int c = 0; c < p->n_fv; c++)
        *adcgs_fmodel_at(f, ADCGS_P_FV, a, c) = (float)model->fv[i * p->n_fv + (size_t)c] * model->d_fv[c];
    for (int c = 0; c < n_sigma; c++)
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, a, c) =
            (float)model->sigma[i * (size_t)n_sigma + (size_t)c] * (model->d_sigma[c] * factor[0]);
    for (int c = 0; c < ADCGS_COLOUR_N; c++)
        *adcgs_fmodel_at(f, ADCGS_P_COLOUR, a, c) =
            (float)model->colour[i * ADCGS_COLOUR_N + (size_t)c] * (model->d_colour[c] * factor[1]);
    for (int k = 0; k < p->k; k++)
        for (int c = 0; c < n_fg; c++)
            *adcgs_fmodel_at(f, ADCGS_P_FG, a, k * n_fg + c) =
                (float)model->fg[(i * p->k + (size_t)k) * (size_t)n_fg + (size_t)c] * (model->d_fg[c] * factor[2 + c / chunk]);
    f->moving[a] = p->time_rows && !model->is_static[a];
    f->body[a] = model->body[a];
    f->tier[a] = model->tier[a];
    f->trainable[a] = 0;
    for (int k = 0; k < p->k; k++)
        f->keep[adcgs_fmodel_slot(f, a, k)] = (float)(model->mask[a] >> k & 1);
}

static adcgs_status take_anchors(adcgs_fmodel *f, const adcgs_model *model, adcgs_cpu_level cpu, adcgs_error *error)
{
    adcgs_steps steps;
    ADCGS_TRY(adcgs_steps_init(&steps, model, cpu, NULL, error));
    float(*factor)[ADCGS_LANES] = adcgs_alloc(NULL, ADCGS_STEPS_MAX, sizeof *factor, error);
    void *scratch = adcgs_alloc(NULL, adcgs_steps_scratch(&steps), 1, error);
    adcgs_status status = factor && scratch ? ADCGS_OK : adcgs_alloc_status(error);
    for (uint32_t a = 0; status == ADCGS_OK && a < model->n; a++) {
        float own[ADCGS_STEPS_MAX];
        if (a % ADCGS_LANES == 0)
            adcgs_steps_factors(&steps, model, a, factor, scratch);
        for (int g = 0; g < ADCGS_STEPS_MAX; g++)
            own[g] = g < steps.n ? factor[g][a % ADCGS_LANES] : 1;
        take_anchor(f, model, a, own);
    }
    adcgs_free(NULL, factor);
    adcgs_free(NULL, scratch);
    adcgs_steps_clear(&steps, NULL);
    return status;
}

adcgs_status adcgs_fmodel_from_model(adcgs_fmodel **out, const adcgs_model *model, const adcgs_shape *shape, uint64_t seed,
                                     adcgs_cpu_level cpu, adcgs_error *error)
{
    if (shape->depth != model->depth)
        return adcgs_fail(error, ADCGS_ERR_DATA, "the previous segment has a grid of depth %u, expected %d", model->depth,
                          shape->depth);
    ADCGS_TRY(adcgs_fmodel_create(out, &model->params, shape, model->origin, model->voxel, (const uint32_t(*)[3])model->pos,
                                  model->n, seed, error));
    adcgs_fmodel *f = *out;
    f->follows = 1;
    memcpy(f->growth, model->growth, sizeof f->growth);
    f->finest = model->finest;
    take_steps(f, model);
    adcgs_status status = take_anchors(f, model, cpu, error);
    adcgs_bodies_recentre(f); /* before the poses, which refer to the centres of these anchors */
    if (status == ADCGS_OK)
        status = take_networks(f, model, error);
    if (status != ADCGS_OK)
        adcgs_fmodel_free(out);
    return status;
}
