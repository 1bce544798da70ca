/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The backward pass: primitives' gradients to anchors and networks. */
#include "fmodel/body_trajectories.h"
#include "fmodel/pass_layout.h"

#include <stdalign.h>

typedef struct backward_job {
    adcgs_pass *pass;
    adcgs_fmodel *f;
    adcgs_deform deform;
    int period, first;
    float rate_scale;
    int only_rate;
} backward_job;

static float *grad_at(const adcgs_fmodel *f, int group, uint32_t g)
{
    return f->param[group].g + (size_t)g * (size_t)adcgs_fmodel_rows(f, group) * ADCGS_LANES;
}

/**
 * Gradients of weights, f_g and f_v from the outputs' gradients. Each primitive is completed while its activations are in the
 * cache. sum, followed by dz: scratch.
 */
static void theta_back(const backward_job *job, uint32_t g, const float *dtheta, float *sum, float *partial)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const adcgs_mlp *m = &f->mlp[ADCGS_P_THETA];
    const adcgs_train_dsp *dsp = p->net;
    const int nv = f->params.n_fv, ng = f->params.n_fg, w = m->width;
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const size_t tile = (size_t)w * ADCGS_LANES;
    float *dz = sum + tile, *gm = partial + p->partial_at[ADCGS_P_THETA];
    float *dfg = grad_at(f, ADCGS_P_FG, g), *dfv = grad_at(f, ADCGS_P_FV, g);
    const float *fv = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * ADCGS_LANES;
    const float *fg = p->used[ADCGS_P_FG] + (size_t)g * f->params.k * (size_t)ng * ADCGS_LANES;
    const int slots = adcgs_slot_inputs(&f->params);
    alignas(64) float one[ADCGS_LANES];
    adcgs_dense_ones(one);
    memset(sum, 0, tile * sizeof *sum);
    for (size_t i = 0; i < f->params.k; i++) {
        const float *h = act.theta_h + i * act.theta_h_stride, *dout = dtheta + i * ADCGS_THETA_OUT * ADCGS_LANES;
        float *d = dfg + i * (size_t)ng * ADCGS_LANES;
        adcgs_mlp_tail_back(dsp, m, h, act.theta_below + i * act.theta_below_stride, dout, dz);
        dsp->dense.dense(d, d, NULL, m->turn + (size_t)(nv + slots) * (size_t)w, (size_t)w, dz, ng, w);
        for (size_t j = 0; j < tile; j++)
            sum[j] += dz[j];
        if (slots)
            dsp->weight_grad(gm + nv + i, (size_t)m->in[0], NULL, dz, 0, one, 0, 1, w, 1);
        dsp->weight_grad(gm + nv + slots, (size_t)m->in[0], NULL, dz, 0, fg + i * (size_t)ng * ADCGS_LANES, 0, 1, w, ng);
        adcgs_mlp_weight_grads(dsp, m, gm, h, 0, dz, 0, dout, 0, 1);
    }
    dsp->dense.dense(dfv, dfv, NULL, m->turn, (size_t)w, sum, nv, w);
    dsp->weight_grad(gm, (size_t)m->in[0], gm + m->b[0], sum, 0, fv, 0, 1, w, nv);
}

/** The same for a deformation network, for its weights after the first layer. */
static void tail_back(const adcgs_pass *p, const adcgs_mlp *m, const float *h, const uint64_t *below, const float *dout,
                      float *dz, float *gm)
{
    adcgs_mlp_tail_back(p->net, m, h, below, dout, dz);
    adcgs_mlp_weight_grads(p->net, m, gm, h, 0, dz, 0, dout, 0, 1);
}

static void deform_back(const backward_job *job, uint32_t g, const float *domega, const float *dvarpi, float *dz, float *partial)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const adcgs_mlp *om = &f->mlp[ADCGS_P_OMEGA], *va = &f->mlp[ADCGS_P_VARPI];
    const adcgs_train_dsp *dsp = p->net;
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const int nv = f->params.n_fv, fp = 6 * f->params.octaves;
    const float *fv = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * ADCGS_LANES;
    float *dfv = grad_at(f, ADCGS_P_FV, g);
    if (om->n) {
        float *gm = partial + p->partial_at[ADCGS_P_OMEGA];
        tail_back(p, om, act.omega_h, act.omega_below, domega, dz, gm);
        dsp->weight_grad(gm, (size_t)om->in[0], gm + om->b[0], dz, 0, fv, 0, 1, om->width, nv);
        dsp->dense.dense(dfv, dfv, NULL, om->turn, (size_t)om->width, dz, nv, om->width);
    }
    if (va->n && job->deform == ADCGS_DEFORM_ALL) {
        float *gm = partial + p->partial_at[ADCGS_P_VARPI];
        const float *code = f->code + (size_t)g * (size_t)fp * ADCGS_LANES;
        tail_back(p, va, act.varpi_h, act.varpi_below, dvarpi, dz, gm);
        dsp->weight_grad(gm, (size_t)va->in[0], gm + va->b[0], dz, 0, code, 0, 1, va->width, fp);
        if (f->params.fine_uses_fv) {
            dsp->weight_grad(gm + fp, (size_t)va->in[0], NULL, dz, 0, fv, 0, 1, va->width, nv);
            dsp->dense.dense(dfv, dfv, NULL, va->turn + (size_t)fp * (size_t)va->width, (size_t)va->width, dz, nv, va->width);
        }
    }
}

static void backward_group(const backward_job *job, uint32_t g, float *scratch, float *partial)
{
    const adcgs_pass *p = job->pass;
    const adcgs_fmodel *f = job->f;
    const size_t at = (size_t)g * f->params.k * ADCGS_LANES;
    adcgs_group_io io;
    adcgs_group_grad grad;
    const adcgs_deform deform = adcgs_pass_deform_of(f, g, job->deform);
    adcgs_pass_io(p, f, g, deform, &io);
    for (int c = 0; c < 3; c++) {
        grad.mean[c] = p->grads.mean[c] + at;
        grad.scale[c] = p->grads.scale[c] + at;
        grad.rgb[c] = p->grads.colour[c] + at;
    }
    for (int c = 0; c < 4; c++)
        grad.rot[c] = p->grads.rotation[c] + at;
    grad.opacity = p->grads.opacity + at;
    grad.sigma = grad_at(f, ADCGS_P_SIGMA, g);
    grad.colour = grad_at(f, ADCGS_P_COLOUR, g);
    grad.theta = scratch;
    grad.omega = scratch + (size_t)f->params.k * ADCGS_THETA_OUT * ADCGS_LANES;
    grad.varpi = grad.omega + f->mlp[ADCGS_P_OMEGA].out * ADCGS_LANES;
    scratch = grad.varpi + f->mlp[ADCGS_P_VARPI].out * ADCGS_LANES;
    grad.body = (adcgs_body_grad *)(partial + p->partial_bodies);
    grad.pull = p->pull ? p->pull + (size_t)g * 12 * ADCGS_LANES : NULL;
    p->dsp.primitives_back(&io, &grad);
    theta_back(job, g, grad.theta, scratch, partial);
    if (deform)
        deform_back(job, g, grad.omega, grad.varpi, scratch, partial);
}

/**
 * Adds to sums, laid out as ADCGS_P_STEP: scale times the sum per step of a group's gradients times `to - from` (times `to` if
 * from is NULL).
 */
static void step_sums(const adcgs_fmodel *f, uint32_t g, float *const to[], float *const from[], float scale, float *sums)
{
    for (int i = 0; i < ADCGS_P_ETA; i++)
        for (int r = 0; r < adcgs_fmodel_rows(f, i); r++) {
            const size_t at = ((size_t)g * (size_t)adcgs_fmodel_rows(f, i) + (size_t)r) * ADCGS_LANES;
            float sum = 0;
            for (size_t l = at; l < at + ADCGS_LANES; l++)
                sum += f->param[i].g[l] * (to[i][l] - (from ? from[i][l] : 0));
            sums[adcgs_fmodel_step_at(f, i, r)] += scale * sum;
        }
}

/**
 * Rate of a group, and the gradient with respect to the logarithms of steps. Steps affect the images through the noise (or the
 * rounding error), which is proportional to them. They affect the rate through the values, which are divided by them.
 */
static void rate_back(const backward_job *job, uint32_t g, float *scratch, float *partial, double *bits)
{
    const adcgs_pass *p = job->pass;
    adcgs_fmodel *f = job->f;
    float *sums = partial + p->partial_at[ADCGS_P_STEP], *values[ADCGS_P_ETA];
    for (int i = 0; i < ADCGS_P_ETA; i++)
        values[i] = f->param[i].p;
    step_sums(f, g, p->used, values, (float)job->period, sums);
    step_sums(f, g, values, NULL, 1, sums);
    adcgs_rate_group(p, f, g, job->rate_scale * (float)job->period, partial, scratch, bits);
    if (adcgs_pass_adapts(p, f) && !job->only_rate)
        adcgs_pass_factors_back(p, f, g, partial, scratch);
    step_sums(f, g, values, NULL, -1, sums);
}

static void backward_chunk(void *arg, int chunk, int thread)
{
    const backward_job *job = arg;
    adcgs_pass *p = job->pass;
    float *scratch = p->scratch + (size_t)thread * p->scratch_stride;
    float *partial = p->partial + (size_t)chunk * p->partial_stride;
    const uint32_t begin = (uint32_t)((uint64_t)p->groups * (uint64_t)chunk / (uint64_t)p->chunks);
    const uint32_t end = (uint32_t)((uint64_t)p->groups * (uint64_t)(chunk + 1) / (uint64_t)p->chunks);
    double *bits = p->bits + (size_t)chunk * ADCGS_GROUPS;
    const int adapts = adcgs_pass_adapts(p, job->f);
    memset(partial, 0, p->partial_stride * sizeof *partial);
    memset(bits, 0, ADCGS_GROUPS * sizeof *bits);
    for (uint32_t g = begin; g < end; g++) {
        if (!job->only_rate)
            backward_group(job, g, scratch, partial);
        if (adapts)
            adcgs_pass_factors_begin(p, job->f, g);
        if (job->period && (g + (uint32_t)job->first) % (uint32_t)job->period == 0)
            rate_back(job, g, scratch, partial, bits);
        else if (adapts)
            adcgs_pass_factors_back(p, job->f, g, partial, scratch);
    }
}

static void merge_partials(adcgs_pass *p, adcgs_fmodel *f)
{
    for (int i = ADCGS_P_ANCHOR; i < ADCGS_P_COUNT; i++)
        for (int c = 0; c < p->chunks; c++) {
            const float *from = p->partial + (size_t)c * p->partial_stride + p->partial_at[i];
            float *to = f->param[i].g;
            for (size_t j = 0; j < f->param[i].n; j++)
                to[j] += from[j];
        }
}

/** Adds the sums of all chunks to the gradients of the poses in the rows around the time. */
static void bodies_back(const adcgs_pass *p, adcgs_fmodel *f)
{
    const int columns = adcgs_fmodel_time_columns(&f->params), n = (int)adcgs_pose_columns(&f->params);
    float sum[ADCGS_BODIES_MAX * sizeof(adcgs_body_grad) / sizeof(float)] = {0}, d[ADCGS_BODIES_MAX * ADCGS_POSE_N];
    const size_t values = f->params.bodies * sizeof(adcgs_body_grad) / sizeof(float);
    adcgs_body_grad grad[ADCGS_BODIES_MAX];
    const adcgs_time_rows at = adcgs_fmodel_time_rows(&f->params, p->t);
    for (int c = 0; c < p->chunks; c++)
        for (size_t i = 0; i < values; i++)
            sum[i] += p->partial[(size_t)c * p->partial_stride + p->partial_bodies + i];
    memcpy(grad, sum, values * sizeof *sum);
    adcgs_bodies_pose_back(f, p->time_code, grad, d);
    float *dz = f->param[ADCGS_P_TIME].g + (size_t)at.first * (size_t)columns + f->params.time_width;
    for (int i = 0; i < at.n; i++)
        for (int j = 0; j < n; j++)
            dz[i * columns + j] += d[j] * at.weight[i];
}

/** Time inputs of the first layers: their gradient follows from the gradient of the per-frame bias. */
static void time_back(adcgs_pass *p, adcgs_fmodel *f)
{
    const int width = f->params.time_width, columns = adcgs_fmodel_time_columns(&f->params);
    const int which[2] = {ADCGS_P_OMEGA, ADCGS_P_VARPI};
    const adcgs_time_rows at = adcgs_fmodel_time_rows(&f->params, p->t);
    float *dz = f->param[ADCGS_P_TIME].g + (size_t)at.first * (size_t)columns;
    for (int i = 0; i < 2; i++) {
        const adcgs_mlp *m = &f->mlp[which[i]];
        float *g = f->param[which[i]].g;
        for (int o = 0; m->n && o < m->width; o++) {
            const float d = g[m->b[0] + (size_t)o];
            const size_t w = (size_t)o * (size_t)m->in[0] + (size_t)m->own;
            for (int j = 0; j < width; j++) {
                g[w + (size_t)j] += d * p->time_code[j];
                const float dcode = d * m->use[w + (size_t)j];
                for (int k = 0; k < at.n; k++)
                    dz[k * columns + j] += dcode * at.weight[k];
            }
        }
    }
}

static void sum_rate(const adcgs_pass *p, int period, adcgs_rate *rate)
{
    memset(rate, 0, sizeof *rate);
    for (int c = 0; c < p->chunks; c++)
        for (int i = 0; i < ADCGS_GROUPS; i++)
            rate->bits[i] += p->bits[c * ADCGS_GROUPS + i] * period;
    for (int i = 0; i < ADCGS_GROUPS; i++)
        rate->total += rate->bits[i];
}

void adcgs_pass_backward(adcgs_pass *p, adcgs_fmodel *f, adcgs_deform deform, float rate_scale, int period, int first,
                         adcgs_rate *rate)
{
    backward_job job = {p,          f, f->params.time_rows ? deform : ADCGS_DEFORM_NONE, rate_scale > 0 ? period : 0, first,
                        rate_scale, 0};
    adcgs_pool_run(p->pool, backward_chunk, &job, p->chunks);
    merge_partials(p, f);
    if (job.deform)
        time_back(p, f);
    if (job.deform && f->params.bodies)
        bodies_back(p, f);
    if (rate)
        sum_rate(p, period, rate);
}

void adcgs_pass_rate(adcgs_pass *p, adcgs_fmodel *f, adcgs_rate *rate)
{
    backward_job job = {p, f, 0, 1, 0, 0, 1};
    p->quant = ADCGS_QUANT_ROUND;
    adcgs_pool_run(p->pool, backward_chunk, &job, p->chunks);
    sum_rate(p, 1, rate);
}
