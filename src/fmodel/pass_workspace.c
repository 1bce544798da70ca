/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Workspace of the passes: its memory and layout. */
#include "fmodel/pass_layout.h"

/** Rows of hidden layers, of the signs of their branches, and of outputs. */
static size_t rows_of(const adcgs_mlp *m)
{
    return (size_t)m->hidden * (size_t)m->width + adcgs_mlp_below_rows(m) + (size_t)m->out;
}

static adcgs_status alloc_groups(adcgs_pass *p, const adcgs_fmodel *f, adcgs_error *error)
{
    const size_t g = f->groups, k = f->params.k, slots = g * k * ADCGS_LANES;
    p->groups = f->groups;
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const size_t n = g * (size_t)adcgs_fmodel_rows(f, i) * ADCGS_LANES;
        p->used[i] = adcgs_alloc(NULL, n, sizeof(float), error);
        p->mu[i] = adcgs_alloc(NULL, n, sizeof(float), error);
        if (!p->used[i] || !p->mu[i])
            return adcgs_alloc_status(error);
    }
    p->factor = adcgs_alloc(NULL, g * (size_t)adcgs_params_steps(&f->params) * ADCGS_LANES, sizeof(float), error);
    p->keep = adcgs_alloc(NULL, slots, sizeof(float), error);
    p->act = adcgs_alloc(NULL, g * p->act_stride, sizeof(float), error);
    p->prim = adcgs_alloc(NULL, slots * ADCGS_ROWS, sizeof(float), error);
    p->grad = adcgs_alloc(NULL, slots * ADCGS_GRAD_ROWS, sizeof(float), error);
    for (size_t i = 0; p->factor && i < g * (size_t)adcgs_params_steps(&f->params) * ADCGS_LANES; i++)
        p->factor[i] = 1;
    if (!p->factor || !p->keep || !p->act || !p->prim || !p->grad)
        return adcgs_alloc_status(error);
    p->primitives = adcgs_rows_primitives(p->prim, (uint32_t)slots);
    p->grads = adcgs_raster_grads_of(p->grad, slots);
    return ADCGS_OK;
}

/** Frees the arrays and sets them to NULL: a pass without groups can still be freed or resized. */
static void free_groups(adcgs_pass *p)
{
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        adcgs_free(NULL, p->used[i]);
        adcgs_free(NULL, p->mu[i]);
        p->used[i] = p->mu[i] = NULL;
    }
    float **const arrays[] = {&p->factor, &p->keep, &p->act, &p->prim, &p->grad};
    for (size_t i = 0; i < ADCGS_COUNTOF(arrays); i++) {
        adcgs_free(NULL, *arrays[i]);
        *arrays[i] = NULL;
    }
}

/** Rows of scratch per thread: the maximum of prediction with deformation, and of the rate. */
static size_t scratch_rows(const adcgs_fmodel *f)
{
    const size_t k = f->params.k, nv = f->params.n_fv, ng = f->params.n_fg;
    const adcgs_mlp *th = &f->mlp[ADCGS_P_THETA], *om = &f->mlp[ADCGS_P_OMEGA], *va = &f->mlp[ADCGS_P_VARPI];
    const size_t theta = k * ADCGS_THETA_OUT + (size_t)(th->width * (1 + th->hidden));
    const size_t deform = (size_t)(om->out + va->out + om->width * om->hidden + va->width * va->hidden);
    const size_t w = (size_t)f->shape.entropy_width * (size_t)(f->shape.entropy_hidden + 1),
                 out = 2 * (nv > ng + 6 ? nv : ng + 6);
    const size_t below = (w + 31) / 32;
    const size_t rate = 2 * nv + k * ng + f->params.n_eta * 2u + k * (3 * w + below + 2 * out) + 2 * w + ng + 64;
    return theta + deform > rate ? theta + deform : rate;
}

adcgs_status adcgs_pass_create(adcgs_pass **out, const adcgs_fmodel *f, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error)
{
    adcgs_pass *p = adcgs_alloc(NULL, 1, sizeof *p, error);
    *out = NULL;
    if (!p)
        return adcgs_alloc_status(error);
    p->cpu = cpu;
    p->pool = pool;
    adcgs_train_dsp_init(&p->dsp, cpu);
    adcgs_train_dsp_init_bf16(&p->bf16, cpu);
    p->net = &p->dsp;
    const adcgs_mlp *m = f->mlp;
    const size_t k = f->params.k;
    const adcgs_mlp *theta = &m[ADCGS_P_THETA], *steps = &m[ADCGS_P_E_STEPS];
    p->act_stride = ADCGS_LANES * (k * rows_of(theta) + rows_of(&m[ADCGS_P_OMEGA]) + rows_of(&m[ADCGS_P_VARPI]) + rows_of(steps) +
                                   (size_t)steps->out);
    p->scratch_stride = ADCGS_LANES * scratch_rows(f);
    size_t at = 0;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        p->partial_at[i] = at;
        at += (f->param[i].n + 15) / 16 * 16;
    }
    p->partial_bodies = at;
    at += (f->params.bodies * (sizeof(adcgs_body_grad) / sizeof(float)) + 15) / 16 * 16;
    p->partial_stride = at;
    p->chunks = ADCGS_PASS_CHUNKS;
    p->scratch = adcgs_alloc(NULL, p->scratch_stride * (size_t)adcgs_pool_threads(pool), sizeof(float), error);
    p->partial = adcgs_alloc(NULL, at * (size_t)p->chunks, sizeof(float), error);
    p->bits = adcgs_alloc(NULL, (size_t)p->chunks * ADCGS_GROUPS, sizeof(double), error);
    p->table = adcgs_alloc(NULL, 1, sizeof *p->table, error);
    p->time_code = adcgs_alloc(NULL, (size_t)adcgs_fmodel_time_columns(&f->params) + 1, sizeof(float), error);
    for (int i = 0; i < 2; i++)
        p->time_bias[i] = adcgs_alloc(NULL, 1024, sizeof(float), error);
    *out = p;
    if (!p->scratch || !p->partial || !p->bits || !p->table || !p->time_code || !p->time_bias[0] || !p->time_bias[1] ||
        alloc_groups(p, f, error) != ADCGS_OK) {
        adcgs_pass_free(out);
        return adcgs_alloc_status(error);
    }
    adcgs_rate_table_init(p->table);
    return ADCGS_OK;
}

void adcgs_pass_free(adcgs_pass **pass)
{
    adcgs_pass *p = *pass;
    if (!p)
        return;
    free_groups(p);
    adcgs_free(NULL, p->scratch);
    adcgs_free(NULL, p->partial);
    adcgs_free(NULL, p->bits);
    adcgs_free(NULL, p->table);
    adcgs_free(NULL, p->time_code);
    for (int i = 0; i < 2; i++)
        adcgs_free(NULL, p->time_bias[i]);
    adcgs_free(NULL, p);
    *pass = NULL;
}

adcgs_status adcgs_pass_resize(adcgs_pass *p, const adcgs_fmodel *f, adcgs_error *error)
{
    free_groups(p);
    return alloc_groups(p, f, error);
}

static int any_body(const adcgs_fmodel *f, uint32_t g)
{
    int any = 0;
    for (size_t l = 0; f->params.bodies && l < ADCGS_LANES; l++)
        any |= f->body[(size_t)g * ADCGS_LANES + l];
    return any;
}

void adcgs_pass_io(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, adcgs_deform deform, adcgs_group_io *io)
{
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const size_t slots = (size_t)f->groups * f->params.k * ADCGS_LANES, at = (size_t)g * f->params.k * ADCGS_LANES;
    io->k = f->params.k;
    io->x = f->x + (size_t)g * 3 * ADCGS_LANES;
    io->sigma = p->used[ADCGS_P_SIGMA] + (size_t)g * (size_t)adcgs_sigma_rows(&f->params) * ADCGS_LANES;
    io->spans = deform && f->params.spans;
    io->t = p->t;
    io->colour = p->used[ADCGS_P_COLOUR] + (size_t)g * ADCGS_COLOUR_N * ADCGS_LANES;
    io->theta = act.theta_out;
    io->omega = deform && f->mlp[ADCGS_P_OMEGA].n ? act.omega_out : NULL;
    io->varpi = deform == ADCGS_DEFORM_ALL && f->mlp[ADCGS_P_VARPI].n ? act.varpi_out : NULL;
    io->moving = f->moving + (size_t)g * ADCGS_LANES;
    io->keep = p->keep + at;
    io->rotation = f->params.coarse_rotation;
    io->body = deform && any_body(f, g) ? f->body + (size_t)g * ADCGS_LANES : NULL;
    io->pose = p->pose;
    const adcgs_slot_out out = adcgs_rows_at(p->prim, slots, at);
    memcpy(io->mean, out.mean, sizeof out.mean);
    memcpy(io->scale, out.scale, sizeof out.scale);
    memcpy(io->rot, out.rotation, sizeof out.rotation);
    memcpy(io->rgb, out.colour, sizeof out.colour);
    io->opacity = out.opacity;
}
