/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Multilayer perceptrons in training. */
#include "fmodel/mlp.h"

#include "grad/random.h"
#include "net/net.h"

#include <math.h>

/* ---- Layout and weights ---- */

size_t adcgs_mlp_layout(adcgs_mlp *mlp, int own, int time, int width, int hidden, int out)
{
    memset(mlp, 0, sizeof *mlp);
    mlp->own = own;
    mlp->time = time;
    mlp->width = width;
    mlp->hidden = own + time ? hidden : 0;
    mlp->out = out;
    size_t at = 0;
    for (int i = 0; i <= mlp->hidden; i++) {
        mlp->in[i] = i == 0 ? own + time : width;
        mlp->n_out[i] = i == mlp->hidden ? out : width;
        mlp->w[i] = at;
        at += (size_t)mlp->in[i] * (size_t)mlp->n_out[i];
        mlp->b[i] = at;
        at += (size_t)mlp->n_out[i];
        mlp->weight_step[i] = ADCGS_WEIGHT_STEP_NONE;
    }
    mlp->n = at;
    return at;
}

size_t adcgs_mlp_set_width(adcgs_mlp *m, int width)
{
    const adcgs_mlp old = *m;
    adcgs_mlp_layout(m, old.own, old.time, width, old.hidden, old.out);
    memcpy(m->weight_step, old.weight_step, sizeof m->weight_step);
    m->use = old.use;
    m->turn = old.turn;
    m->packed = old.packed;
    m->entropy = old.entropy;
    return m->n;
}

adcgs_status adcgs_mlp_alloc(adcgs_mlp *m, adcgs_error *error)
{
    m->use = adcgs_alloc(NULL, 2 * (m->n + 16), sizeof *m->use, error);
    if (!m->use)
        return adcgs_alloc_status(error);
    m->turn = m->use + (m->n + 15) / 16 * 16;
    if (m->hidden < 2 || m->entropy)
        return ADCGS_OK;
    m->packed = adcgs_alloc(NULL, 2 * (size_t)(m->hidden - 1) * adcgs_square_words(m->width), sizeof *m->packed, error);
    return m->packed ? ADCGS_OK : adcgs_alloc_status(error);
}

void adcgs_mlp_clear(adcgs_mlp *m)
{
    adcgs_free(NULL, m->use);
    adcgs_free(NULL, m->packed);
}

void adcgs_mlp_start(const adcgs_mlp *mlp, float *p, float last, uint64_t seed, uint64_t stream)
{
    for (int i = 0; i <= mlp->hidden; i++) {
        const float residual = i > 0 && i < mlp->hidden ? 0.5f : 1.0f;
        const double gain = (i == mlp->hidden ? last : residual) * sqrt(3.0 / (mlp->in[i] > 0 ? mlp->in[i] : 1));
        for (int j = 0; j < mlp->in[i] * mlp->n_out[i]; j++)
            p[mlp->w[i] + (size_t)j] = (float)(gain * (2 * adcgs_random_unit(seed, stream, mlp->w[i] + (uint64_t)j) - 1));
    }
}

/** Rounds to the lattice of the integer networks or a coarser one. NaN, in a run that is about to roll back, becomes -limit. */
static float integer_weight(float w, int e, int limit)
{
    const float v = rintf(ldexpf(w, e)) * (float)(1 << (ADCGS_E24_BITS - e));
    return v > (float)-limit ? fminf(v, (float)limit) : (float)-limit;
}

/**
 * Enforces the decoder's bound on a row, A*sum|w| + |b| + 2^(s-1) <= 2^24 - 1 with any shift s of the integer networks, by
 * halving the row. Networks that train normally never need it.
 */
static void bound_row(float *w, float *b, int n)
{
    for (;;) {
        double sum = 0;
        for (int i = 0; i < n; i++)
            sum += fabs((double)w[i]);
        if (ADCGS_E24_MAX * sum + (1 << ADCGS_E24_BITS) * fabs((double)*b) + (1 << (2 * ADCGS_E24_BITS)) < 1 << 24)
            return;
        for (int i = 0; i < n; i++)
            w[i] = truncf(w[i] / 2);
        *b = truncf(*b / 2);
    }
}

void adcgs_mlp_integer(const adcgs_mlp *m, const float *p, float *to)
{
    for (int i = 0; i <= m->hidden; i++) {
        const size_t inputs = (size_t)m->in[i];
        const int e = ADCGS_MIN(m->weight_step[i], ADCGS_E24_BITS);
        for (size_t o = 0; o < (size_t)m->n_out[i]; o++) {
            float *w = to + m->w[i] + o * inputs, *b = to + m->b[i] + o;
            for (size_t j = 0; j < inputs; j++)
                w[j] = integer_weight(p[m->w[i] + o * inputs + j], e, ADCGS_E24_MAX);
            *b = integer_weight(p[m->b[i] + o], e, 1 << 14);
            bound_row(w, b, m->in[i]);
            for (size_t j = 0; j < inputs; j++)
                w[j] = ldexpf(w[j], -ADCGS_E24_BITS);
            *b = ldexpf(*b, -ADCGS_E24_BITS);
        }
    }
}

void adcgs_mlp_prepare(adcgs_mlp *mlp, const float *p, int quantise)
{
    if (quantise && mlp->entropy)
        adcgs_mlp_integer(mlp, p, mlp->use);
    else
        memcpy(mlp->use, p, mlp->n * sizeof *p);
    for (int i = 0; i <= mlp->hidden; i++) {
        const size_t n = (i < mlp->hidden ? mlp->w[i + 1] : mlp->n) - mlp->w[i]; /* weights and biases */
        float *w = mlp->use + mlp->w[i];
        if (quantise && !mlp->entropy && mlp->weight_step[i] != ADCGS_WEIGHT_STEP_NONE) {
            const float up = ldexpf(1, mlp->weight_step[i]), down = ldexpf(1, -mlp->weight_step[i]);
            for (size_t j = 0; j < n; j++)
                w[j] = rintf(w[j] * up) * down;
        }
        for (int o = 0; o < mlp->n_out[i]; o++)
            for (int j = 0; j < mlp->in[i]; j++)
                mlp->turn[mlp->w[i] + (size_t)j * (size_t)mlp->n_out[i] + (size_t)o] =
                    w[(size_t)o * (size_t)mlp->in[i] + (size_t)j];
    }
}

void adcgs_mlp_pack(const adcgs_train_dsp *dsp, const adcgs_mlp *mlp)
{
    for (int i = 1; mlp->n && dsp->pack && i < mlp->hidden; i++) {
        dsp->pack(adcgs_mlp_packed(mlp, i, 0), mlp->use + mlp->w[i], mlp->width);
        dsp->pack(adcgs_mlp_packed(mlp, i, 1), mlp->turn + mlp->w[i], mlp->width);
    }
}

/* ---- Evaluation ---- */

void adcgs_mlp_tail(const adcgs_train_dsp *dsp, const adcgs_mlp *m, float *h, uint64_t *below, float *out)
{
    const size_t tile = (size_t)m->width * ADCGS_LANES;
    dsp->dense.lrelu(h, m->width);
    for (int i = 1; i < m->hidden; i++) {
        float *next = h + (size_t)i * tile;
        dsp->residual(dsp, next, below + (i - 1) * m->width, m->use + m->b[i],
                      &(adcgs_square){m->width, m->use + m->w[i], adcgs_mlp_packed(m, i, 0)}, next - tile);
    }
    dsp->dense.dense(out, NULL, m->use + m->b[m->hidden], m->use + m->w[m->hidden], (size_t)m->width,
                     h + (size_t)(m->hidden - 1) * tile, m->out, m->width);
}

void adcgs_mlp_tail_back(const adcgs_train_dsp *dsp, const adcgs_mlp *m, const float *h, const uint64_t *below, const float *dout,
                         float *dz)
{
    const size_t tile = (size_t)m->width * ADCGS_LANES;
    /* dz[0] carries dL/dh down to layer 0, where it becomes that layer's gradient. */
    dsp->dense.dense(dz, NULL, NULL, m->turn + m->w[m->hidden], (size_t)m->out, dout, m->width, m->out);
    for (int i = m->hidden - 1; i > 0; i--) {
        const adcgs_square turn = {m->width, m->turn + m->w[i], adcgs_mlp_packed(m, i, 1)};
        dsp->residual_back(dsp, dz, dz + (size_t)i * tile, below + (i - 1) * m->width, &turn, dz, h + (size_t)(i - 1) * tile);
    }
    dsp->lrelu_back(dz, h, m->width);
}

void adcgs_mlp_weight_grads(const adcgs_train_dsp *dsp, const adcgs_mlp *m, float *g, const float *h, size_t sh, const float *dz,
                            size_t sdz, const float *dout, size_t sdout, int tiles)
{
    const size_t tile = (size_t)m->width * ADCGS_LANES;
    for (int i = 1; i < m->hidden; i++)
        dsp->weight_grad(g + m->w[i], (size_t)m->width, g + m->b[i], dz + (size_t)i * tile, sdz, h + (size_t)(i - 1) * tile, sh,
                         tiles, m->width, m->width);
    const int last = m->hidden;
    dsp->weight_grad(g + m->w[last], (size_t)m->width, g + m->b[last], dout, sdout, h + (size_t)(last - 1) * tile, sh, tiles,
                     m->out, m->width);
}
