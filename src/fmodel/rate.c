/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Bits of a group of anchors under the float twins of the entropy networks, with gradients into features and networks (paper
 * section 3.4; the contexts are those of spec clause "Latent chain"). Before rounding, the twins get the features with noise.
 * Once training rounds, they are exact: they follow the chain like the coder, with its integers, means and tables, and gradients
 * pass straight through every rounding.
 */
#include "fmodel/pass_layout.h"
#include "splat/steps.h"

/** The current group. x, dx: inputs of networks and their gradients. */
typedef struct job {
    const adcgs_pass *p;
    adcgs_fmodel *f;
    uint32_t group;
    int exact;
    float scale;
    float *xe, *dxe, *xv, *dxv, *xg; /* eta; f_v; f_g [k][n_fg][64] */
    double *bits;                    /* by adcgs_group */
} job;

/**
 * Scratch of one network over `tiles` tiles: sums and outputs of hidden layers, gradients of the sums, outputs, and sign masks of
 * the sums.
 */
typedef struct net_tiles {
    float *z, *h, *dz, *out, *dout;
    uint64_t *below;
    size_t sh, sbelow, sout;
} net_tiles;

static net_tiles take_tiles(const adcgs_mlp *m, int tiles, float **scratch)
{
    net_tiles t;
    t.sh = (size_t)m->hidden * (size_t)m->width * ADCGS_LANES;
    t.sbelow = ((size_t)m->hidden * (size_t)m->width + 31) / 32 * 32;
    t.sout = (size_t)m->out * ADCGS_LANES;
    const size_t n = (size_t)tiles;
    t.z = *scratch;
    t.h = t.z + n * t.sh;
    t.dz = t.h + n * t.sh;
    t.out = t.dz + n * t.sh;
    t.dout = t.out + n * t.sout;
    t.below = (void *)(t.dout + n * t.sout);
    *scratch = (float *)(t.below + n * t.sbelow);
    return t;
}

/** g += dx / (gain*step): from gradients of inputs to gradients of values. */
static void unscale_rows(float *g, const float *dx, const float *step, int rows)
{
    for (int r = 0; r < rows; r++) {
        const float s = 1 / (ADCGS_MU_GAIN * step[r]);
        for (int l = 0; l < ADCGS_LANES; l++)
            g[r * ADCGS_LANES + l] += dx[r * ADCGS_LANES + l] * s;
    }
}

/** Factor of a coded group's steps at these anchors: [64], or NULL. */
static const float *factor_of(const job *j, int stream)
{
    const int adapts = adcgs_pass_adapts(j->p, j->f) && stream >= ADCGS_GROUP_SIGMA;
    return adapts ? adcgs_pass_factors(j->p, j->f, j->group) + adcgs_group_steps(stream) * ADCGS_LANES : NULL;
}

/**
 * With adaptive steps: converts gradients dv with respect to values in units of their factor to gradients of the values and of
 * the factor. The rows start at `first` of a parameter group. unit: steps per row if dv belongs to network inputs; otherwise
 * NULL.
 */
static void adapted_back(const job *j, int param, int stream, int first, int rows, const float *dv, const float *unit)
{
    const size_t at = ((size_t)j->group * (size_t)adcgs_fmodel_rows(j->f, param) + (size_t)first) * ADCGS_LANES;
    const float *factor = factor_of(j, stream), *y = j->f->param[param].p + at;
    float *dy = j->f->param[param].g + at;
    float *dlog = adcgs_pass_act(j->p, j->f, j->group).steps_dlog + adcgs_group_steps(stream) * ADCGS_LANES;
    for (int r = 0; r < rows; r++)
        for (int l = 0; l < ADCGS_LANES; l++) {
            const float d = dv[r * ADCGS_LANES + l] / (factor[l] * (unit ? ADCGS_MU_GAIN * unit[r] : 1));
            dy[r * ADCGS_LANES + l] += d;
            dlog[l] -= d * y[r * ADCGS_LANES + l];
        }
}

/** Layers 1.. of a network; z holds layer 0's sums. */
static void net_tail(const job *j, const adcgs_mlp *m, float *z, float *h, uint64_t *below, float *out)
{
    const adcgs_train_dsp *dsp = &j->p->dsp;
    const size_t tile = (size_t)m->width * ADCGS_LANES;
    for (int i = 0; i < m->hidden; i++, z += tile, h += tile, below += m->width) {
        if (i > 0)
            dsp->dense.dense(z, NULL, m->use + m->b[i], m->use + m->w[i], (size_t)m->width, h - tile, m->width, m->width);
        (j->exact ? dsp->hidden_exact : dsp->hidden)(h, below, z, i > 0 ? h - tile : NULL, m->width);
    }
    dsp->dense.dense(out, NULL, m->use + m->b[m->hidden], m->use + m->w[m->hidden], (size_t)m->width, h - tile, m->out, m->width);
}

/** Coded rows: `count` rows from row `first` of a parameter group in this group of anchors. */
typedef struct coded {
    int param, first, count;
    adcgs_group stream;
    const float *weight;
    float *x; /* receives the values as inputs, or NULL */
} coded;

/** Bits of the lifetimes, whose rows follow those of io. */
static double rate_spans(const job *j, const adcgs_rate_io *io)
{
    _Alignas(64) float weight[ADCGS_LANES];
    const float *moving = j->f->moving + (size_t)j->group * ADCGS_LANES;
    const size_t skip = (size_t)ADCGS_SIGMA_N * ADCGS_LANES;
    adcgs_rate_io rest = *io;
    for (int l = 0; l < ADCGS_LANES; l++)
        weight[l] = io->weight[l] * moving[l];
    rest.n = ADCGS_SPAN_N;
    rest.weight = weight;
    rest.y += skip;
    rest.dy += skip;
    rest.step += ADCGS_SIGMA_N;
    rest.mu += skip;
    rest.si += skip;
    rest.dmu += skip;
    rest.dsi += skip;
    rest.mean += skip;
    return (j->exact ? j->p->dsp.rate_exact : j->p->dsp.rate)(&rest);
}

/** Bits of rows under a network's outputs; dout receives their gradient. Rows with a factor are coded in units of it. */
static void rate_rows(const job *j, const coded *c, const float *out, float *dout)
{
    _Alignas(64) float values[ADCGS_NG_MAX * ADCGS_LANES], gradients[ADCGS_NG_MAX * ADCGS_LANES];
    const float *factor = factor_of(j, c->stream);
    const size_t at = ((size_t)j->group * (size_t)adcgs_fmodel_rows(j->f, c->param) + (size_t)c->first) * ADCGS_LANES;
    const size_t half = (size_t)c->count * ADCGS_LANES;
    adcgs_rate_io io = {
        .n = c->count,
        .y = (j->exact ? j->f->param[c->param].p : j->p->used[c->param]) + at,
        .step = j->f->step[c->param] + c->first,
        .mu = out,
        .si = out + half,
        .weight = c->weight,
        .scale = j->scale,
        .dy = j->f->param[c->param].g + at,
        .dmu = dout,
        .dsi = dout + half,
        .x = c->x,
        .table = j->p->table,
        .mean = j->p->mu[c->param] + at,
    };
    for (size_t i = 0; factor && i < half; i++) {
        values[i] = io.y[i] / factor[i % ADCGS_LANES];
        gradients[i] = 0;
    }
    if (factor) {
        io.y = values;
        io.dy = gradients;
    }
    const int spans = c->stream == ADCGS_GROUP_SIGMA && c->count > ADCGS_SIGMA_N; /* static anchors have none */
    io.n = spans ? ADCGS_SIGMA_N : c->count;
    j->bits[c->stream] += (j->exact ? j->p->dsp.rate_exact : j->p->dsp.rate)(&io);
    if (spans)
        j->bits[c->stream] += rate_spans(j, &io);
    if (factor)
        adapted_back(j, c->param, (int)c->stream, c->first, c->count, gradients, NULL);
}

/** Computes the current factors: E_q as in the coder, on the f_v in xv. */
static void exact_factors(const job *j, float *scratch)
{
    const adcgs_mlp *m = &j->f->mlp[ADCGS_P_E_STEPS];
    const net_tiles t = take_tiles(m, 1, &scratch);
    float *factor = adcgs_pass_factors(j->p, j->f, j->group);
    j->p->dsp.dense.dense(t.z, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], j->xv, m->width, m->in[0]);
    net_tail(j, m, t.z, t.h, t.below, t.out);
    for (int i = 0; i < m->out * ADCGS_LANES; i++)
        factor[i] = adcgs_step_factor(
            (int)adcgs_bounded(floorf(ADCGS_STEP_GAIN * t.out[i] + 0.5f), -ADCGS_STEP_INDEX_MAX, ADCGS_STEP_INDEX_MAX));
}

/** One network on one tile: forward, bits, backward; dx accumulates the gradient of the input, [in][64]. */
static void rate_net(const job *j, int net, const float *x, float *dx, const coded *c, float *partial, float *scratch)
{
    const adcgs_train_dsp *dsp = &j->p->dsp;
    const adcgs_mlp *m = &j->f->mlp[net];
    float *g = partial + j->p->partial_at[net];
    const net_tiles t = take_tiles(m, 1, &scratch);
    if (!m->hidden) { /* no inputs: the biases are the outputs */
        for (int o = 0; o < m->out; o++)
            for (int l = 0; l < ADCGS_LANES; l++)
                t.out[o * ADCGS_LANES + l] = m->use[m->b[0] + (size_t)o];
        rate_rows(j, c, t.out, t.dout);
        dsp->weight_grad(g, 1, g + m->b[0], t.dout, 0, t.dout, 0, 1, m->out, 0);
        return;
    }
    dsp->dense.dense(t.z, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], x, m->width, m->in[0]);
    net_tail(j, m, t.z, t.h, t.below, t.out);
    rate_rows(j, c, t.out, t.dout);
    adcgs_mlp_tail_back(dsp, m, t.z, t.below + m->width, t.dout, t.dz);
    dsp->weight_grad(g, (size_t)m->in[0], g + m->b[0], t.dz, 0, x, 0, 1, m->width, m->in[0]);
    adcgs_mlp_weight_grads(dsp, m, g, t.h, t.sh, t.dz, t.sh, t.dout, t.sout, 1);
    dsp->dense.dense(dx, dx, NULL, m->turn, (size_t)m->width, t.dz, m->in[0], m->width);
}

/** Propagates gradients to the chunks of a primitive's f_g that are inputs: `before` rows, `per` in a chunk. */
static void fg_context_back(const job *j, int k, const float *dx, int before, int per)
{
    const int ng = j->f->params.n_fg;
    const float *step = j->f->step[ADCGS_P_FG];
    if (!adcgs_pass_adapts(j->p, j->f)) {
        const size_t slot = (size_t)j->group * (size_t)j->f->params.k + (size_t)k;
        unscale_rows(j->f->param[ADCGS_P_FG].g + slot * (size_t)ng * ADCGS_LANES, dx, step, before);
        return;
    }
    for (int r = 0; r < before; r += per)
        adapted_back(j, ADCGS_P_FG, ADCGS_GROUP_FG + r / per, k * ng + r, per, dx + r * ADCGS_LANES, step + r);
}

/** Chunk c of f_g for all primitives of the group. */
static void rate_chunk(const job *j, int c, float *partial, float *scratch)
{
    const adcgs_train_dsp *dsp = &j->p->dsp;
    const adcgs_mlp *m = &j->f->mlp[ADCGS_P_E_FG + c];
    const int nv = j->f->params.n_fv, ng = j->f->params.n_fg, per = ng / j->f->params.chunks, before = c * per;
    const int k = j->f->params.k, w = m->width;
    const size_t fg_tile = (size_t)ng * ADCGS_LANES, tile = (size_t)w * ADCGS_LANES;
    float *g = partial + j->p->partial_at[ADCGS_P_E_FG + c];
    float *anchor = scratch, *sum = scratch + tile, *dx = sum + tile, *rest = dx + (size_t)(before + 1) * ADCGS_LANES;
    const net_tiles t = take_tiles(m, k, &rest);
    dsp->dense.dense(anchor, NULL, m->use + m->b[0], m->use, (size_t)m->in[0], j->xv, w, nv);
    memset(sum, 0, tile * sizeof *sum);
    for (int i = 0; i < k; i++) {
        const size_t slot = (size_t)j->group * (size_t)k + (size_t)i;
        float *z = t.z + (size_t)i * t.sh, *h = t.h + (size_t)i * t.sh, *dz = t.dz + (size_t)i * t.sh;
        uint64_t *below = t.below + (size_t)i * t.sbelow;
        float *out = t.out + (size_t)i * t.sout, *dout = t.dout + (size_t)i * t.sout, *xg = j->xg + (size_t)i * fg_tile;
        const coded values = {ADCGS_P_FG,
                              i * ng + before,
                              per,
                              (adcgs_group)(ADCGS_GROUP_FG + c),
                              j->f->keep + slot * ADCGS_LANES,
                              xg + (size_t)before * ADCGS_LANES};
        dsp->dense.dense(z, anchor, NULL, m->use + nv, (size_t)m->in[0], xg, w, before);
        net_tail(j, m, z, h, below, out);
        rate_rows(j, &values, out, dout);
        adcgs_mlp_tail_back(dsp, m, z, below + w, dout, dz);
        for (size_t q = 0; q < tile; q++)
            sum[q] += dz[q];
        if (before) {
            dsp->dense.dense(dx, NULL, NULL, m->turn + (size_t)nv * (size_t)w, (size_t)w, dz, before, w);
            fg_context_back(j, i, dx, before, per);
        }
    }
    dsp->dense.dense(j->dxv, j->dxv, NULL, m->turn, (size_t)w, sum, nv, w);
    dsp->weight_grad(g, (size_t)m->in[0], g + m->b[0], sum, 0, j->xv, 0, 1, w, nv);
    if (before)
        dsp->weight_grad(g + nv, (size_t)m->in[0], NULL, t.dz, t.sh, j->xg, fg_tile, k, w, before);
    adcgs_mlp_weight_grads(dsp, m, g, t.h, t.sh, t.dz, t.sh, t.dout, t.sout, k);
}

/** eta under its prior: one mean and level per channel. */
static void rate_eta(const job *j, const coded *c, float *partial, float *scratch)
{
    const int n = 2 * c->count;
    float *out = scratch, *dout = out + n * ADCGS_LANES;
    const float *prior = j->f->param[ADCGS_P_ETA_PRIOR].p;
    for (int i = 0; i < n; i++)
        for (int l = 0; l < ADCGS_LANES; l++)
            out[i * ADCGS_LANES + l] = prior[i];
    rate_rows(j, c, out, dout);
    j->p->dsp.weight_grad(NULL, 0, partial + j->p->partial_at[ADCGS_P_ETA_PRIOR], dout, 0, dout, 0, 1, n, 0);
}

void adcgs_rate_group(const adcgs_pass *p, adcgs_fmodel *f, uint32_t group, float scale, float *partial, float *scratch,
                      double *bits)
{
    const int nv = f->params.n_fv, ng = f->params.n_fg, ne = f->params.n_eta, k = f->params.k;
    job j = {p, f, group, p->quant == ADCGS_QUANT_ROUND, scale, NULL, NULL, NULL, NULL, NULL, bits};
    j.xv = scratch;
    j.dxv = j.xv + nv * ADCGS_LANES;
    j.xe = j.dxv + nv * ADCGS_LANES;
    j.dxe = j.xe + ne * ADCGS_LANES;
    j.xg = j.dxe + ne * ADCGS_LANES;
    float *rest = j.xg + (size_t)k * (size_t)ng * ADCGS_LANES;
    const float *live = f->live + (size_t)group * ADCGS_LANES;
    const coded eta = {ADCGS_P_ETA, 0, ne, ADCGS_GROUP_ETA, live, j.xe}, fv = {ADCGS_P_FV, 0, nv, ADCGS_GROUP_FV, live, j.xv};
    const coded sigma = {ADCGS_P_SIGMA, 0, adcgs_sigma_rows(&f->params), ADCGS_GROUP_SIGMA, live, NULL};
    const coded colour = {ADCGS_P_COLOUR, 0, ADCGS_COLOUR_N, ADCGS_GROUP_COLOUR, live, NULL};
    memset(j.dxv, 0, (size_t)nv * ADCGS_LANES * sizeof *j.dxv);
    memset(j.dxe, 0, (size_t)ne * ADCGS_LANES * sizeof *j.dxe);
    if (ne)
        rate_eta(&j, &eta, partial, rest);
    rate_net(&j, ADCGS_P_E_FV, j.xe, j.dxe, &fv, partial, rest);
    if (j.exact && adcgs_pass_adapts(p, f))
        exact_factors(&j, rest);
    rate_net(&j, ADCGS_P_E_SIGMA, j.xv, j.dxv, &sigma, partial, rest);
    rate_net(&j, ADCGS_P_E_COLOUR, j.xv, j.dxv, &colour, partial, rest);
    for (int c = 0; c < f->params.chunks && ng; c++)
        rate_chunk(&j, c, partial, rest);
    unscale_rows(f->param[ADCGS_P_FV].g + (size_t)group * (size_t)nv * ADCGS_LANES, j.dxv, f->step[ADCGS_P_FV], nv);
    unscale_rows(f->param[ADCGS_P_ETA].g + (size_t)group * (size_t)ne * ADCGS_LANES, j.dxe, f->step[ADCGS_P_ETA], ne);
}
