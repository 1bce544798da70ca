/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Adaptive steps: the float twin of E_q, factors of steps, and their gradient. With F the factor of a step s, the networks see y
 * + F s u, where the noise u (or the rounding error in its place) does not depend on F. The rate is that of y/(F s) + u. So the
 * image gradient with respect to ln F is the image gradient with respect to y times F s u, and the rate's is its gradient with
 * respect to y times -y.
 */
#include "base/fmath.h"
#include "fmodel/pass_layout.h"

static const float ln2 = 0.69314718f; /* arithmetic */
/* Octaves: the largest factor of a step; definition of the format. */
static const float octaves_max = ADCGS_STEP_INDEX_MAX / ADCGS_STEP_GAIN;

int adcgs_pass_factor_of(const adcgs_fmodel *f, int group, int row)
{
    const int per_chunk = f->params.n_fg / f->params.chunks;
    switch (group) {
    case ADCGS_P_SIGMA:
        return adcgs_group_steps(ADCGS_GROUP_SIGMA);
    case ADCGS_P_COLOUR:
        return adcgs_group_steps(ADCGS_GROUP_COLOUR);
    case ADCGS_P_FG:
        return per_chunk ? adcgs_group_steps(ADCGS_GROUP_FG + row % f->params.n_fg / per_chunk) : -1;
    default:
        return -1;
    }
}

void adcgs_pass_divide(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, int group, float *to, const float *from)
{
    for (int r = 0; r < adcgs_fmodel_rows(f, group); r++, to += ADCGS_LANES, from += ADCGS_LANES) {
        const float *factor = adcgs_pass_factors(p, f, g) + adcgs_pass_factor_of(f, group, r) * ADCGS_LANES;
        for (int l = 0; l < ADCGS_LANES; l++)
            to[l] = from[l] / factor[l];
    }
}

void adcgs_pass_multiply(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, int group, float *to, const float *from)
{
    for (int r = 0; r < adcgs_fmodel_rows(f, group); r++, to += ADCGS_LANES, from += ADCGS_LANES) {
        const float *factor = adcgs_pass_factors(p, f, g) + adcgs_pass_factor_of(f, group, r) * ADCGS_LANES;
        for (int l = 0; l < ADCGS_LANES; l++)
            to[l] = from[l] * factor[l];
    }
}

/** Inputs of E_q: the quantised f_v, in units of 16 steps. */
static void inputs(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, float *x)
{
    const int nv = f->params.n_fv;
    const float *used = p->used[ADCGS_P_FV] + (size_t)g * (size_t)nv * ADCGS_LANES;
    for (int r = 0; r < nv; r++) {
        const float s = 1 / (ADCGS_MU_GAIN * f->step[ADCGS_P_FV][r]);
        for (int l = 0; l < ADCGS_LANES; l++)
            x[r * ADCGS_LANES + l] = used[r * ADCGS_LANES + l] * s;
    }
}

void adcgs_pass_evaluate_factors(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g, int set, float *scratch)
{
    const adcgs_mlp *m = &f->mlp[ADCGS_P_E_STEPS];
    const adcgs_act act = adcgs_pass_act(p, f, g);
    float *factor = adcgs_pass_factors(p, f, g);
    inputs(p, f, g, scratch);
    p->dsp.dense.dense(act.steps_h, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], scratch, m->width, m->in[0]);
    adcgs_mlp_tail(&p->dsp, m, act.steps_h, act.steps_below, act.steps_out);
    for (int i = 0; set && i < m->out * ADCGS_LANES; i++)
        factor[i] = adcgs_exp(ln2 * adcgs_bounded(act.steps_out[i], -octaves_max, octaves_max));
}

void adcgs_pass_factors_begin(const adcgs_pass *p, const adcgs_fmodel *f, uint32_t g)
{
    float *dlog = adcgs_pass_act(p, f, g).steps_dlog;
    memset(dlog, 0, (size_t)f->mlp[ADCGS_P_E_STEPS].out * ADCGS_LANES * sizeof *dlog);
    for (int i = 0; i < ADCGS_P_ANCHOR; i++)
        for (int r = 0; r < adcgs_fmodel_rows(f, i); r++) {
            const int of = adcgs_pass_factor_of(f, i, r);
            const size_t at = ((size_t)g * (size_t)adcgs_fmodel_rows(f, i) + (size_t)r) * ADCGS_LANES;
            for (size_t l = 0; of >= 0 && l < ADCGS_LANES; l++)
                dlog[(size_t)of * ADCGS_LANES + l] += f->param[i].g[at + l] * (p->used[i][at + l] - f->param[i].p[at + l]);
        }
}

void adcgs_pass_factors_back(const adcgs_pass *p, adcgs_fmodel *f, uint32_t g, float *partial, float *scratch)
{
    const adcgs_mlp *m = &f->mlp[ADCGS_P_E_STEPS];
    const adcgs_act act = adcgs_pass_act(p, f, g);
    const int nv = f->params.n_fv;
    float *x = scratch, *dx = x + nv * ADCGS_LANES, *dz = dx + nv * ADCGS_LANES, *gm = partial + p->partial_at[ADCGS_P_E_STEPS];
    float *dfv = f->param[ADCGS_P_FV].g + (size_t)g * (size_t)nv * ADCGS_LANES;
    for (int i = 0; i < m->out * ADCGS_LANES; i++) { /* outputs beyond the limits may only move back towards them */
        const float d = ln2 * act.steps_dlog[i], octaves = act.steps_out[i];
        act.steps_dlog[i] = (octaves > octaves_max && d < 0) || (octaves < -octaves_max && d > 0) ? 0 : d;
    }
    inputs(p, f, g, x);
    adcgs_mlp_tail_back(&p->dsp, m, act.steps_h, act.steps_below, act.steps_dlog, dz);
    p->dsp.weight_grad(gm, (size_t)m->in[0], gm + m->b[0], dz, 0, x, 0, 1, m->width, m->in[0]);
    adcgs_mlp_weight_grads(&p->dsp, m, gm, act.steps_h, 0, dz, 0, act.steps_dlog, 0, 1);
    p->dsp.dense.dense(dx, NULL, NULL, m->turn, (size_t)m->width, dz, nv, m->width);
    for (int r = 0; r < nv; r++) {
        const float s = 1 / (ADCGS_MU_GAIN * f->step[ADCGS_P_FV][r]);
        for (int l = 0; l < ADCGS_LANES; l++)
            dfv[r * ADCGS_LANES + l] += dx[r * ADCGS_LANES + l] * s;
    }
}
