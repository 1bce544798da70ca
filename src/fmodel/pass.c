/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Workspace of the passes and the forward pass. */
#include "fmodel/pass_layout.h"

#include <math.h>

/* ---- Workspace ---- */

/** Hidden layers, their branches' signs, outputs. */
static size_t rows_of(const adcgs_mlp *m)
{
    return (size_t)m->hidden * (size_t)m->width + adcgs_below_rows(m) + (size_t)m->out;
}

static adcgs_status alloc_groups(adcgs_pass *p, const adcgs_fmodel *f, adcgs_error *error)
{
    const size_t g = f->groups, k = f->params.k, slots = g * k * 64;
    p->groups = f->groups;
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const size_t n = g * (size_t)adcgs_fmodel_rows(f, i) * 64;
        p->used[i] = adcgs_alloc(NULL, n, sizeof(float), error);
        p->mu[i] = adcgs_alloc(NULL, n, sizeof(float), error);
        if (!p->used[i] || !p->mu[i])
            return adcgs_alloc_status(error);
    }
    p->factor = adcgs_alloc(NULL, g * (size_t)adcgs_params_steps(&f->params) * 64, sizeof(float), error);
    p->keep = adcgs_alloc(NULL, slots, sizeof(float), error);
    p->act = adcgs_alloc(NULL, g * p->act_stride, sizeof(float), error);
    p->prim = adcgs_alloc(NULL, slots * 14, sizeof(float), error);
    p->grad = adcgs_alloc(NULL, slots * 16, sizeof(float), error);
    for (size_t i = 0; p->factor && i < g * (size_t)adcgs_params_steps(&f->params) * 64; i++)
        p->factor[i] = 1;
    if (!p->factor || !p->keep || !p->act || !p->prim || !p->grad)
        return adcgs_alloc_status(error);
    float *a = p->prim, *d = p->grad;
    adcgs_primitives *r = &p->primitives;
    r->n = (uint32_t)slots;
    for (int c = 0; c < 3; c++) {
        r->mean[c] = a + (size_t)c * slots;
        r->scale[c] = a + (size_t)(3 + c) * slots;
        r->colour[c] = a + (size_t)(11 + c) * slots;
        p->grads.mean[c] = d + (size_t)c * slots;
        p->grads.scale[c] = d + (size_t)(3 + c) * slots;
        p->grads.colour[c] = d + (size_t)(11 + c) * slots;
    }
    for (int c = 0; c < 4; c++) {
        r->rotation[c] = a + (size_t)(6 + c) * slots;
        p->grads.rotation[c] = d + (size_t)(6 + c) * slots;
    }
    r->opacity = a + 10 * slots;
    p->grads.opacity = d + 10 * slots;
    p->grads.weight = d + 14 * slots;
    p->grads.screen = d + 15 * slots;
    return ADCGS_OK;
}

/** Nothing is left that could be freed again: a pass without groups can still be freed, or resized. */
static void free_groups(adcgs_pass *p)
{
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        adcgs_free(NULL, p->used[i]);
        adcgs_free(NULL, p->mu[i]);
        p->used[i] = p->mu[i] = NULL;
    }
    float **const arrays[] = { &p->factor, &p->keep, &p->act, &p->prim, &p->grad };
    for (size_t i = 0; i < ADCGS_COUNTOF(arrays); i++) {
        adcgs_free(NULL, *arrays[i]);
        *arrays[i] = NULL;
    }
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
    p->act_stride = 64 * (k * rows_of(theta) + rows_of(&m[ADCGS_P_OMEGA]) + rows_of(&m[ADCGS_P_VARPI]) + rows_of(steps) +
                          (size_t)steps->out);
    p->scratch_stride = 64 * adcgs_pass_scratch_rows(f);
    size_t at = 0;
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++) {
        p->partial_at[i] = at;
        at += (f->param[i].n + 15) / 16 * 16;
    }
    p->partial_stride = at;
    p->chunks = ADCGS_PASS_CHUNKS;
    p->scratch = adcgs_alloc(NULL, p->scratch_stride * (size_t)adcgs_pool_threads(pool), sizeof(float), error);
    p->partial = adcgs_alloc(NULL, at * (size_t)p->chunks, sizeof(float), error);
    p->bits = adcgs_alloc(NULL, (size_t)p->chunks * ADCGS_GROUPS, sizeof(double), error);
    p->tables = adcgs_alloc(NULL, ADCGS_SHAPES, sizeof *p->tables, error);
    p->time_code = adcgs_alloc(NULL, (size_t)f->params.time_width + 1, sizeof(float), error);
    for (int i = 0; i < 2; i++)
        p->time_bias[i] = adcgs_alloc(NULL, 1024, sizeof(float), error);
    *out = p;
    if (!p->scratch || !p->partial || !p->bits || !p->tables || !p->time_code || !p->time_bias[0] || !p->time_bias[1] ||
        alloc_groups(p, f, error) != ADCGS_OK) {
        adcgs_pass_free(out);
        return adcgs_alloc_status(error);
    }
    for (int i = 0; i < ADCGS_SHAPES; i++)
        adcgs_rate_table_init(&p->tables[i], i);
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
    adcgs_free(NULL, p->tables);
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

/* ---- Forward ---- */

void adcgs_mlp_tail(const adcgs_train_dsp *dsp, const adcgs_mlp *m, float *h, uint64_t *below, float *out)
{
    const size_t tile = (size_t)m->width * 64;
    dsp->dense.lrelu(h, m->width);
    for (int i = 1; i < m->hidden; i++) {
        float *next = h + (size_t)i * tile;
        dsp->residual(dsp, next, below + (i - 1) * m->width, m->use + m->b[i],
                      &(adcgs_square){ m->width, m->use + m->w[i], adcgs_mlp_packed(m, i, 0) }, next - tile);
    }
    dsp->dense.dense(out, NULL, m->use + m->b[m->hidden], m->use + m->w[m->hidden], (size_t)m->width,
                     h + (size_t)(m->hidden - 1) * tile, m->out, m->width);
}

typedef struct forward_job {
    adcgs_pass *pass;
    const adcgs_fmodel *f;
    const adcgs_pass_mode *mode;
    adcgs_deform deform;
} forward_job;

static void quantise_rows(const forward_job *job, uint32_t g, int i, float *to, const float *value)
{
    const adcgs_pass *p = job->pass;
    const int rows = adcgs_fmodel_rows(job->f, i);
    const float *step = job->f->step[i];
    if (job->mode->quant == ADCGS_QUANT_NOISE)
        p->dsp.noise(to, value, step, rows, adcgs_mix32(job->mode->seed ^ (g * ADCGS_P_ANCHOR + (uint32_t)i)));
    else if (job->mode->quant == ADCGS_QUANT_ROUND)
        p->dsp.round(to, value, step, p->mu[i] + (size_t)g * (size_t)rows * 64, rows);
    else
        memcpy(to, value, (size_t)rows * 64 * sizeof *value);
}

/** f_v comes first: the steps of the others may follow from it. */
static void quantise_group(const forward_job *job, uint32_t g, float *scratch)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const int adapts = adcgs_pass_adapts(p, f);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const size_t at = (size_t)g * (size_t)adcgs_fmodel_rows(f, i) * 64;
        float *used = p->used[i] + at;
        if (adapts && adcgs_pass_factor_of(f, i, 0) >= 0) { /* in units of the factors, and back */
            adcgs_pass_divide(p, f, g, i, scratch, f->param[i].p + at);
            quantise_rows(job, g, i, used, scratch);
            adcgs_pass_multiply(p, f, g, i, used, used);
        } else {
            quantise_rows(job, g, i, used, f->param[i].p + at);
        }
        if (adapts && i == ADCGS_P_FV)
            adcgs_pass_evaluate_factors(p, f, g, job->mode->quant == ADCGS_QUANT_NOISE, scratch);
    }
}

static void forward_theta(const forward_job *job, uint32_t g, float *anchor)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const adcgs_mlp *m = &f->mlp[ADCGS_P_THETA];
    const adcgs_dense_dsp *d = &p->net->dense;
    const int nv = f->params.n_fv, ng = f->params.n_fg;
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const float *fv = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * 64;
    const float *fg = p->used[ADCGS_P_FG] + (size_t)g * f->params.k * (size_t)ng * 64;
    d->dense(anchor, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], fv, m->width, nv);
    for (int k = 0; k < f->params.k; k++) {
        float *h = act.theta_h + (size_t)k * act.theta_h_stride;
        d->dense(h, anchor, NULL, m->use + nv, (size_t)m->in[0], fg + (size_t)k * (size_t)ng * 64, m->width, ng);
        adcgs_mlp_tail(p->net, m, h, act.theta_below + (size_t)k * act.theta_below_stride,
                       act.theta_out + (size_t)k * ADCGS_THETA_OUT * 64);
    }
}

static void forward_deform(const forward_job *job, uint32_t g)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const adcgs_dense_dsp *d = &p->net->dense;
    const int nv = f->params.n_fv, fp = 6 * f->params.octaves;
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const float *fv = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * 64;
    const adcgs_mlp *om = &f->mlp[ADCGS_P_OMEGA], *va = &f->mlp[ADCGS_P_VARPI];
    if (om->n) {
        d->dense(act.omega_h, NULL, p->time_bias[0], om->use, (size_t)om->in[0], fv, om->width, nv);
        adcgs_mlp_tail(p->net, om, act.omega_h, act.omega_below, act.omega_out);
    }
    if (va->n && job->deform == ADCGS_DEFORM_ALL) {
        d->dense(act.varpi_h, NULL, p->time_bias[1], va->use, (size_t)va->in[0], f->code + (size_t)g * (size_t)fp * 64, va->width,
                 fp);
        if (f->params.fine_uses_fv)
            d->dense(act.varpi_h, act.varpi_h, NULL, va->use + fp, (size_t)va->in[0], fv, va->width, nv);
        adcgs_mlp_tail(p->net, va, act.varpi_h, act.varpi_below, act.varpi_out);
    }
}

void adcgs_pass_io(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, adcgs_deform deform, adcgs_group_io *io)
{
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const size_t slots = (size_t)f->groups * f->params.k * 64, at = (size_t)g * f->params.k * 64;
    io->k = f->params.k;
    io->x = f->x + (size_t)g * 3 * 64;
    io->sigma = p->used[ADCGS_P_SIGMA] + (size_t)g * ADCGS_SIGMA_N * 64;
    io->colour = p->used[ADCGS_P_COLOUR] + (size_t)g * ADCGS_COLOUR_N * 64;
    io->theta = act.theta_out;
    io->omega = deform && f->mlp[ADCGS_P_OMEGA].n ? act.omega_out : NULL;
    io->varpi = deform == ADCGS_DEFORM_ALL && f->mlp[ADCGS_P_VARPI].n ? act.varpi_out : NULL;
    io->moving = f->moving + (size_t)g * 64;
    io->keep = p->keep + at;
    io->rotation = f->params.coarse_rotation;
    for (int c = 0; c < 3; c++) {
        io->mean[c] = p->prim + (size_t)c * slots + at;
        io->scale[c] = p->prim + (size_t)(3 + c) * slots + at;
        io->rgb[c] = p->prim + (size_t)(11 + c) * slots + at;
    }
    for (int c = 0; c < 4; c++)
        io->rot[c] = p->prim + (size_t)(6 + c) * slots + at;
    io->opacity = p->prim + 10 * slots + at;
}

static void drop_primitives(const forward_job *job, uint32_t g)
{
    const size_t n = (size_t)job->f->params.k * 64, at = g * n;
    const uint32_t seed = adcgs_mix32(job->mode->seed ^ 0x5bd1e995u), below = (uint32_t)(job->mode->dropout * 0x1p32f);
    for (size_t i = at; i < at + n; i++)
        job->pass->keep[i] = below && adcgs_mix32(seed + (uint32_t)i) < below ? 0 : job->f->keep[i];
}

static void forward_group(void *arg, int index, int thread)
{
    const forward_job *job = arg;
    const uint32_t g = (uint32_t)index;
    float *scratch = job->pass->scratch + (size_t)thread * job->pass->scratch_stride;
    quantise_group(job, g, scratch);
    drop_primitives(job, g);
    forward_theta(job, g, scratch);
    if (job->deform)
        forward_deform(job, g);
    adcgs_group_io io;
    adcgs_pass_io(job->pass, job->f, g, job->deform, &io);
    job->pass->dsp.primitives(&io);
}

static void forward_time(adcgs_pass *p, const adcgs_fmodel *f, float t)
{
    const int width = f->params.time_width;
    int row;
    const float frac = adcgs_fmodel_time_row(&f->params, t, &row);
    const float *z = f->mlp[ADCGS_P_TIME].use + (size_t)row * (size_t)width;
    for (int j = 0; j < width; j++)
        p->time_code[j] = f->params.time_rows > 1 ? z[j] + frac * (z[j + width] - z[j]) : z[j];
    const int which[2] = { ADCGS_P_OMEGA, ADCGS_P_VARPI };
    for (int i = 0; i < 2; i++) {
        const adcgs_mlp *m = &f->mlp[which[i]];
        for (int o = 0; m->n && o < m->width; o++) {
            const float *w = m->use + (size_t)o * (size_t)m->in[0] + m->own;
            float acc = m->use[m->b[0] + (size_t)o];
            for (int j = 0; j < width; j++)
                acc += w[j] * p->time_code[j];
            p->time_bias[i][o] = acc;
        }
    }
    p->t = t;
}

void adcgs_pass_forward(adcgs_pass *p, const adcgs_fmodel *f, float t, const adcgs_pass_mode *mode)
{
    forward_job job = { p, f, mode, f->params.time_rows ? mode->deform : ADCGS_DEFORM_NONE };
    p->quant = mode->quant;
    p->net = mode->bf16 ? &p->bf16 : &p->dsp;
    for (int i = ADCGS_P_THETA; i <= ADCGS_P_VARPI; i++)
        adcgs_mlp_pack(p->net, &f->mlp[i]);
    if (job.deform)
        forward_time(p, f, t);
    adcgs_pool_run(p->pool, forward_group, &job, (int)f->groups);
}

/* The time part of the first layers: their bias gradient is the gradient of the per-frame bias vector. */
void adcgs_pass_time_back(adcgs_pass *p, adcgs_fmodel *f)
{
    const int width = f->params.time_width;
    const int which[2] = { ADCGS_P_OMEGA, ADCGS_P_VARPI };
    float *dz = f->param[ADCGS_P_TIME].g;
    int row;
    const float frac = adcgs_fmodel_time_row(&f->params, p->t, &row);
    for (int i = 0; i < 2; i++) {
        const adcgs_mlp *m = &f->mlp[which[i]];
        float *g = f->param[which[i]].g;
        for (int o = 0; m->n && o < m->width; o++) {
            const float d = g[m->b[0] + (size_t)o];
            const size_t w = (size_t)o * (size_t)m->in[0] + (size_t)m->own;
            for (int j = 0; j < width; j++) {
                g[w + (size_t)j] += d * p->time_code[j];
                const float dcode = d * m->use[w + (size_t)j];
                dz[row * width + j] += dcode * (1 - frac);
                if (f->params.time_rows > 1)
                    dz[(row + 1) * width + j] += dcode * frac;
            }
        }
    }
}
