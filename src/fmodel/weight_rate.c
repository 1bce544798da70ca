/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Bits of the networks' weights, and their gradient. */
#include "fmodel/weight_rate.h"

#include <math.h>

#define LOG2_E 1.44269504f /* 1 / ln 2; arithmetic */
#define COLUMNS_MAX ADCGS_NET_INPUTS_MAX

/** A tensor [rows][cols]. `round`: magnitudes below it count quadratically, so that there is a gradient at 0. */
typedef struct tensor {
    const float *w;
    float *g; /**< or NULL */
    int rows, cols;
    float round, width; /**< width: of the density of a weight among zeros */
} tensor;

/** d|w|/dw. */
static inline float slope(const tensor *t, float w)
{
    const float x = w / t->round;
    return x > 1 ? 1 : x < -1 ? -1 : x;
}

static inline float magnitude(const tensor *t, float w)
{
    const float s = slope(t, w);
    return s * (w - 0.5f * t->round * s);
}

static float row_mean(const tensor *t, const float *w)
{
    float sum = 0;
    for (int j = 0; j < t->cols; j++)
        sum += magnitude(t, w[j]);
    return sum / (float)t->cols;
}

/**
 * Bits of one row; column: mean magnitudes of the columns. A weight of magnitude a under a density of width b costs log2(b /
 * width) + a / (b ln 2). b is half its row's mean plus half its column's plus the width. by_width accumulates, per column, the
 * derivative of the bits with respect to b.
 */
static double rate_row(const tensor *t, const float *w, float *g, const float *column, float *by_width, float scale)
{
    const float row = row_mean(t, w);
    float sum = 0;
    double bits = 0;
    for (int j = 0; j < t->cols; j++) {
        const float b = 0.5f * (row + column[j]) + t->width, a = magnitude(t, w[j]), by_b = LOG2_E * (b - a) / (b * b);
        bits += (double)(log2f(b / t->width) + LOG2_E * a / b);
        sum += by_b;
        by_width[j] += by_b;
        if (g)
            g[j] += scale * slope(t, w[j]) * LOG2_E / b;
    }
    for (int j = 0; g && j < t->cols; j++)
        g[j] += scale * slope(t, w[j]) * 0.5f * sum / (float)t->cols;
    return bits;
}

static double rate_tensor(const tensor *t, float scale)
{
    float column[COLUMNS_MAX] = {0}, by_width[COLUMNS_MAX] = {0};
    const size_t cols = (size_t)t->cols;
    double bits = 0;
    if (!t->rows || !t->cols)
        return 0;
    for (int i = 0; i < t->rows; i++)
        for (size_t j = 0; j < cols; j++)
            column[j] += magnitude(t, t->w[(size_t)i * cols + j]);
    for (size_t j = 0; j < cols; j++)
        column[j] /= (float)t->rows;
    for (int i = 0; i < t->rows; i++)
        bits += rate_row(t, t->w + (size_t)i * cols, t->g ? t->g + (size_t)i * cols : NULL, column, by_width, scale);
    for (int i = 0; t->g && i < t->rows; i++)
        for (size_t j = 0; j < cols; j++) {
            const size_t at = (size_t)i * cols + j;
            t->g[at] += scale * slope(t, t->w[at]) * 0.5f * by_width[j] / (float)t->rows;
        }
    return bits;
}

double adcgs_weight_rate(adcgs_fmodel *f, int group, float scale)
{
    const adcgs_mlp *m = &f->mlp[group];
    const float *p = f->param[group].p;
    float *g = scale > 0 ? f->param[group].g : NULL;
    double bits = 0;
    for (int l = 0; m->n && l <= m->hidden; l++) {
        const int e = m->weight_step[l] == ADCGS_WEIGHT_STEP_NONE ? ADCGS_E24_BITS : m->weight_step[l];
        const size_t end = l < m->hidden ? m->w[l + 1] : m->n;
        const float half = ldexpf(0.5f, -e);
        const tensor w = {p + m->w[l], g ? g + m->w[l] : NULL, m->n_out[l], m->in[l], half, half};
        const tensor b = {p + m->b[l], g ? g + m->b[l] : NULL, (int)(end - m->b[l]), 1, half, half};
        bits += rate_tensor(&w, scale) + rate_tensor(&b, scale);
    }
    return bits;
}
