/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The forward pass: from parameters and a time to primitives. */
#include "fmodel/body_trajectories.h"
#include "fmodel/pass_layout.h"

#include <stdalign.h>

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
        p->dsp.round(to, value, step, p->mu[i] + (size_t)g * (size_t)rows * ADCGS_LANES, rows);
    else
        memcpy(to, value, (size_t)rows * ADCGS_LANES * sizeof *value);
}

/** Keeps the values of frozen anchors, which are already those of the stream. */
static void spare_settled(const adcgs_fmodel *f, uint32_t g, float *to, const float *value, int rows)
{
    const float *trainable = f->trainable + (size_t)g * ADCGS_LANES;
    for (int r = 0; r < rows; r++, to += ADCGS_LANES, value += ADCGS_LANES)
        for (int l = 0; l < ADCGS_LANES; l++)
            to[l] = trainable[l] != 0 ? to[l] : value[l];
}

/** Quantises a group. f_v is first, because the other steps may depend on it. */
static void quantise_group(const forward_job *job, uint32_t g, float *scratch)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const int adapts = adcgs_pass_adapts(p, f);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        const size_t at = (size_t)g * (size_t)adcgs_fmodel_rows(f, i) * ADCGS_LANES;
        float *used = p->used[i] + at;
        if (adapts && adcgs_pass_factor_of(f, i, 0) >= 0) { /* in units of the factors, and back */
            adcgs_pass_divide(p, f, g, i, scratch, f->param[i].p + at);
            quantise_rows(job, g, i, used, scratch);
            adcgs_pass_multiply(p, f, g, i, used, used);
        } else {
            quantise_rows(job, g, i, used, f->param[i].p + at);
        }
        if (f->follows && job->mode->quant == ADCGS_QUANT_NOISE)
            spare_settled(f, g, used, f->param[i].p + at, adcgs_fmodel_rows(f, i));
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
    const float *fv = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * ADCGS_LANES;
    const float *fg = p->used[ADCGS_P_FG] + (size_t)g * f->params.k * (size_t)ng * ADCGS_LANES;
    const int slots = adcgs_slot_inputs(&f->params);
    alignas(64) float one[ADCGS_LANES];
    adcgs_dense_ones(one);
    d->dense(anchor, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], fv, m->width, nv);
    for (int k = 0; k < f->params.k; k++) {
        float *h = act.theta_h + (size_t)k * act.theta_h_stride;
        d->dense(h, anchor, NULL, m->use + nv + k, (size_t)m->in[0], one, m->width, slots > 0); /* slot input, if any */
        d->dense(h, h, NULL, m->use + nv + slots, (size_t)m->in[0], fg + (size_t)k * (size_t)ng * ADCGS_LANES, m->width, ng);
        adcgs_mlp_tail(p->net, m, h, act.theta_below + (size_t)k * act.theta_below_stride,
                       act.theta_out + (size_t)k * ADCGS_THETA_OUT * ADCGS_LANES);
    }
}

static void forward_deform(const forward_job *job, uint32_t g)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const adcgs_dense_dsp *d = &p->net->dense;
    const int nv = f->params.n_fv, fp = 6 * f->params.octaves;
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const float *fv = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * ADCGS_LANES;
    const adcgs_mlp *om = &f->mlp[ADCGS_P_OMEGA], *va = &f->mlp[ADCGS_P_VARPI];
    if (om->n) {
        d->dense(act.omega_h, NULL, p->time_bias[0], om->use, (size_t)om->in[0], fv, om->width, nv);
        adcgs_mlp_tail(p->net, om, act.omega_h, act.omega_below, act.omega_out);
    }
    if (va->n && job->deform == ADCGS_DEFORM_ALL) {
        const float *code = f->code + (size_t)g * (size_t)fp * ADCGS_LANES;
        d->dense(act.varpi_h, NULL, p->time_bias[1], va->use, (size_t)va->in[0], code, va->width, fp);
        if (f->params.fine_uses_fv)
            d->dense(act.varpi_h, act.varpi_h, NULL, va->use + fp, (size_t)va->in[0], fv, va->width, nv);
        adcgs_mlp_tail(p->net, va, act.varpi_h, act.varpi_below, act.varpi_out);
    }
}

static void drop_primitives(const forward_job *job, uint32_t g)
{
    const size_t n = (size_t)job->f->params.k * ADCGS_LANES, at = g * n;
    const uint32_t seed = adcgs_mix32(job->mode->seed ^ 0x5bd1e995u), below = (uint32_t)(job->mode->dropout * 0x1p32f);
    for (size_t i = at; i < at + n; i++)
        job->pass->keep[i] = below && adcgs_mix32(seed + (uint32_t)i) < below ? 0 : job->f->keep[i];
}

static void forward_group(void *arg, int index, int thread)
{
    const forward_job *job = arg;
    const uint32_t g = (uint32_t)index;
    float *scratch = job->pass->scratch + (size_t)thread * job->pass->scratch_stride;
    const adcgs_deform deform = adcgs_pass_deform_of(job->f, g, job->deform);
    if (!job->mode->other_time) {
        quantise_group(job, g, scratch);
        drop_primitives(job, g);
        forward_theta(job, g, scratch);
    }
    if (deform)
        forward_deform(job, g);
    adcgs_group_io io;
    adcgs_pass_io(job->pass, job->f, g, deform, &io);
    job->pass->dsp.primitives(&io);
}

static void forward_time(adcgs_pass *p, const adcgs_fmodel *f, float t)
{
    const int width = f->params.time_width, columns = adcgs_fmodel_time_columns(&f->params);
    const adcgs_time_rows at = adcgs_fmodel_time_rows(&f->params, t);
    const float *z = f->mlp[ADCGS_P_TIME].use + (size_t)at.first * (size_t)columns;
    for (int j = 0; j < columns; j++) {
        p->time_code[j] = 0;
        for (int i = 0; i < at.n; i++)
            p->time_code[j] += at.weight[i] * z[i * columns + j];
    }
    adcgs_bodies_pose(f, p->time_code, p->pose);
    const int which[2] = {ADCGS_P_OMEGA, ADCGS_P_VARPI};
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
    forward_job job = {p, f, mode, f->params.time_rows ? mode->deform : ADCGS_DEFORM_NONE};
    p->quant = mode->quant;
    p->net = mode->bf16 ? &p->bf16 : &p->dsp;
    for (int i = ADCGS_P_THETA; i <= ADCGS_P_VARPI; i++)
        adcgs_mlp_pack(p->net, &f->mlp[i]);
    if (job.deform)
        forward_time(p, f, t);
    adcgs_pool_run(p->pool, forward_group, &job, (int)f->groups);
}
