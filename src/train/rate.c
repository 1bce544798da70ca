/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bits of a group of anchors under the float twins of the entropy networks,
 * with gradients into features and networks (paper section 3.4; the contexts
 * are those of spec clause "Latent chain").
 */
#include "train/pass_layout.h"

size_t adcgs_pass_scratch_rows(const adcgs_fmodel *f)
{
    const size_t k = f->params.k, nv = f->params.n_fv, ng = f->params.n_fg;
    const adcgs_mlp *th = &f->mlp[ADCGS_P_THETA];
    const size_t theta = k * ADCGS_THETA_OUT + (size_t)th->width * (1 + k * (size_t)th->hidden);
    const size_t w = (size_t)f->shape.entropy_width * (size_t)(f->shape.entropy_hidden + 1),
        out = 2 * (nv > ng + 6 ? nv : ng + 6);
    const size_t rate = 2 * nv + k * ng + f->params.n_eta * 2u + k * (3 * w + 2 * out) + 2 * w + ng + 64;
    return theta > rate ? theta : rate;
}

/** Scratch of one network over `tiles` tiles. */
typedef struct net_tiles {
    float *h, *a, *dz, *out, *dout;
    size_t sh, sa, sout;
} net_tiles;

static net_tiles take_tiles(const adcgs_mlp *m, int tiles, float **scratch)
{
    net_tiles t;
    t.sh = (size_t)m->hidden * (size_t)m->width * 64;
    t.sa = adcgs_pass_branches(m) * (size_t)m->width * 64;
    t.sout = (size_t)m->out * 64;
    const size_t n = (size_t)tiles;
    t.h = *scratch;
    t.a = t.h + n * t.sh;
    t.dz = t.a + n * t.sa;
    t.out = t.dz + n * t.sh;
    t.dout = t.out + n * t.sout;
    *scratch = t.dout + n * t.sout;
    return t;
}

static void scale_rows(float *x, const float *y, const float *step, int rows)
{
    for (int r = 0; r < rows; r++) {
        const float s = 1 / (ADCGS_MU_GAIN * step[r]);
        for (int l = 0; l < 64; l++)
            x[r * 64 + l] = y[r * 64 + l] * s;
    }
}

/** g += dx / (gain*step): the way back through scale_rows. */
static void unscale_rows(float *g, const float *dx, const float *step, int rows)
{
    for (int r = 0; r < rows; r++) {
        const float s = 1 / (ADCGS_MU_GAIN * step[r]);
        for (int l = 0; l < 64; l++)
            g[r * 64 + l] += dx[r * 64 + l] * s;
    }
}

/** What is coded: rows of values with their gradient. */
typedef struct coded {
    const float *y, *step, *weight;
    float *dy;
    int rows;
} coded;

/** One network on one tile: forward, bits, backward; dx accumulates [in][64] of the input's gradient. */
static double rate_net(const adcgs_train_dsp *dsp, const adcgs_mlp *m, const float *x, float *dx, const coded *c, float scale,
                       float *g, float *scratch)
{
    const net_tiles t = take_tiles(m, 1, &scratch);
    const int half = m->out / 2;
    if (!m->hidden) { /* no inputs: the biases are the outputs */
        for (int o = 0; o < m->out; o++)
            for (int l = 0; l < 64; l++)
                t.out[o * 64 + l] = m->use[m->b[0] + (size_t)o];
    } else {
        dsp->dense.dense(t.h, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], x, m->width, m->in[0]);
        adcgs_mlp_tail(dsp, m, t.h, t.a, t.out);
    }
    const double bits = dsp->rate(c->y, c->step, t.out, t.out + half * 64, c->weight, c->rows, scale, c->dy, t.dout,
                                  t.dout + half * 64);
    if (!m->hidden) {
        dsp->weight_grad(g, 1, g + m->b[0], t.dout, 0, t.dout, 0, 1, m->out, 0);
        return bits;
    }
    adcgs_mlp_tail_back(dsp, m, t.h, t.a, t.dout, t.dz);
    dsp->weight_grad(g, (size_t)m->in[0], g + m->b[0], t.dz, 0, x, 0, 1, m->width, m->in[0]);
    adcgs_mlp_weight_grads(dsp, m, g, t.h, t.sh, t.dz, t.sh, t.dout, t.sout, 1);
    dsp->dense.dense(dx, dx, NULL, m->turn, (size_t)m->width, t.dz, m->in[0], m->width);
    return bits;
}

/** Chunk c of f_g for all primitives of the group. xv, dxv: f_v input and its gradient; xg: scaled f_g [k][n_fg][64]. */
static double rate_chunk(const adcgs_pass *p, adcgs_fmodel *f, uint32_t group, int c, const float *xv, float *dxv,
                         const float *xg, float scale, float *g, float *scratch)
{
    const adcgs_train_dsp *dsp = &p->dsp;
    const adcgs_mlp *m = &f->mlp[ADCGS_P_E_FG + c];
    const int nv = f->params.n_fv, ng = f->params.n_fg, per = ng / f->params.chunks, before = c * per, k = f->params.k,
        w = m->width;
    const size_t fg_tile = (size_t)ng * 64, tile = (size_t)w * 64;
    float *anchor = scratch, *sum = scratch + tile, *dx = sum + tile, *rest = dx + (size_t)(before + 1) * 64;
    const net_tiles t = take_tiles(m, k, &rest);
    const float *step = f->step[ADCGS_P_FG];
    double bits = 0;
    dsp->dense.dense(anchor, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], xv, w, nv);
    memset(sum, 0, tile * sizeof *sum);
    for (int i = 0; i < k; i++) {
        const size_t row = ((size_t)group * (size_t)k + (size_t)i) * fg_tile;
        float *h = t.h + (size_t)i * t.sh, *dz = t.dz + (size_t)i * t.sh, *a = t.a + (size_t)i * t.sa;
        float *out = t.out + (size_t)i * t.sout, *dout = t.dout + (size_t)i * t.sout;
        dsp->dense.dense(h, anchor, NULL, m->use + nv, (size_t)m->in[0], xg + (size_t)i * fg_tile, w, before);
        adcgs_mlp_tail(dsp, m, h, a, out);
        bits += dsp->rate(p->used[ADCGS_P_FG] + row + (size_t)before * 64, step + before, out, out + per * 64,
                          f->keep + ((size_t)group * (size_t)k + (size_t)i) * 64, per, scale,
                          f->param[ADCGS_P_FG].g + row + (size_t)before * 64, dout, dout + per * 64);
        adcgs_mlp_tail_back(dsp, m, h, a, dout, dz);
        for (size_t j = 0; j < tile; j++)
            sum[j] += dz[j];
        if (before) {
            dsp->dense.dense(dx, NULL, NULL, m->turn + (size_t)nv * (size_t)w, (size_t)w, dz, before, w);
            unscale_rows(f->param[ADCGS_P_FG].g + row, dx, step, before);
        }
    }
    dsp->dense.dense(dxv, dxv, NULL, m->turn, (size_t)w, sum, nv, w);
    dsp->weight_grad(g, (size_t)m->in[0], g + m->b[0], sum, 0, xv, 0, 1, w, nv);
    if (before)
        dsp->weight_grad(g + nv, (size_t)m->in[0], NULL, t.dz, t.sh, xg, fg_tile, k, w, before);
    adcgs_mlp_weight_grads(dsp, m, g, t.h, t.sh, t.dz, t.sh, t.dout, t.sout, k);
    return bits;
}

/** eta under its prior: one mean and level per channel. */
static double rate_eta(const adcgs_pass *p, const adcgs_fmodel *f, float scale, const coded *c, float *g, float *scratch)
{
    const int n = c->rows;
    float *mu = scratch, *si = mu + n * 64, *dmu = si + n * 64, *dsi = dmu + n * 64;
    const float *prior = f->param[ADCGS_P_ETA_PRIOR].p;
    for (int i = 0; i < n; i++)
        for (int l = 0; l < 64; l++) {
            mu[i * 64 + l] = prior[i];
            si[i * 64 + l] = prior[n + i];
        }
    const double bits = p->dsp.rate(c->y, c->step, mu, si, c->weight, n, scale, c->dy, dmu, dsi);
    p->dsp.weight_grad(NULL, 0, g, dmu, 0, dmu, 0, 1, 2 * n, 0);
    return bits;
}

void adcgs_rate_group(const adcgs_pass *p, adcgs_fmodel *f, uint32_t group, float scale, float *partial, float *scratch,
                      double *bits)
{
    const int nv = f->params.n_fv, ng = f->params.n_fg, ne = f->params.n_eta, k = f->params.k;
    coded part[ADCGS_P_ANCHOR];
    for (int i = 0; i < ADCGS_P_ANCHOR; i++) {
        part[i].rows = adcgs_fmodel_rows(f, i);
        const size_t at = (size_t)group * (size_t)part[i].rows * 64;
        part[i].y = p->used[i] + at;
        part[i].dy = f->param[i].g + at;
        part[i].step = f->step[i];
        part[i].weight = f->live + (size_t)group * 64;
    }
    float *xv = scratch, *dxv = xv + nv * 64, *xe = dxv + nv * 64, *dxe = xe + ne * 64, *xg = dxe + ne * 64;
    float *rest = xg + (size_t)k * (size_t)ng * 64;
    scale_rows(xv, part[ADCGS_P_FV].y, part[ADCGS_P_FV].step, nv);
    scale_rows(xe, part[ADCGS_P_ETA].y, part[ADCGS_P_ETA].step, ne);
    scale_rows(xg, part[ADCGS_P_FG].y, part[ADCGS_P_FG].step, k * ng);
    memset(dxv, 0, (size_t)nv * 64 * sizeof *dxv);
    memset(dxe, 0, (size_t)ne * 64 * sizeof *dxe);
#define NET(which) &f->mlp[which]
#define GRAD(which) partial + p->partial_at[which]
    if (ne)
        bits[ADCGS_P_ETA] += rate_eta(p, f, scale, &part[ADCGS_P_ETA], GRAD(ADCGS_P_ETA_PRIOR), rest);
    bits[ADCGS_P_FV] += rate_net(&p->dsp, NET(ADCGS_P_E_FV), xe, dxe, &part[ADCGS_P_FV], scale, GRAD(ADCGS_P_E_FV), rest);
    bits[ADCGS_P_SIGMA] += rate_net(&p->dsp, NET(ADCGS_P_E_SIGMA), xv, dxv, &part[ADCGS_P_SIGMA], scale, GRAD(ADCGS_P_E_SIGMA),
                                    rest);
    bits[ADCGS_P_COLOUR] += rate_net(&p->dsp, NET(ADCGS_P_E_COLOUR), xv, dxv, &part[ADCGS_P_COLOUR], scale,
                                     GRAD(ADCGS_P_E_COLOUR), rest);
    for (int c = 0; c < f->params.chunks && ng; c++)
        bits[ADCGS_P_FG] += rate_chunk(p, f, group, c, xv, dxv, xg, scale, GRAD(ADCGS_P_E_FG + c), rest);
#undef NET
#undef GRAD
    unscale_rows(part[ADCGS_P_FV].dy, dxv, part[ADCGS_P_FV].step, nv);
    unscale_rows(part[ADCGS_P_ETA].dy, dxe, part[ADCGS_P_ETA].step, ne);
}
