/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Primitives of a model at a time, evaluated one by one as the specification describes, without SIMD or threads. */
#ifndef ADCGS_TESTS_SPLAT_REFERENCE_H
#define ADCGS_TESTS_SPLAT_REFERENCE_H

#include "base/fmath.h"
#include "splat/floatnet.h"
#include "splat/steps.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static const double PI = 3.14159265358979323846;

typedef struct primitive {
    float v[14]; /* mean, scale, rotation, opacity, colour */
} primitive;

static inline float weight(const adcgs_layer *l, uint32_t row, uint32_t column)
{
    return adcgs_tensor_value(&l->w, (size_t)row * l->w.cols + column);
}

static inline float bent(float x)
{
    return x < 0.0f ? x * 0x1p-6f : x;
}

/* Layers after the first; h holds the first one's sums and becomes the outputs. */
static inline void later_layers(const adcgs_net *net, float *h)
{
    float next[ADCGS_NET_WIDTH_MAX];
    for (int i = 1; i < net->n_layers; i++) {
        const adcgs_layer *l = &net->layer[i];
        if (i == 1)
            for (uint32_t j = 0; j < l->w.cols; j++)
                h[j] = bent(h[j]);
        for (uint32_t o = 0; o < l->w.rows; o++) {
            float sum = adcgs_tensor_value(&l->b, o);
            for (uint32_t j = 0; j < l->w.cols; j++)
                sum = fmaf(weight(l, o, j), h[j], sum);
            next[o] = i + 1 == net->n_layers ? sum : l->residual ? h[o] + bent(sum) : bent(sum);
        }
        memcpy(h, next, l->w.rows * sizeof *h);
    }
}

static inline void normalise(float q[4])
{
    float n = q[0] * q[0];
    for (int i = 1; i < 4; i++)
        n = fmaf(q[i], q[i], n);
    const int ok = n >= 0x1p-40f && n <= 0x1p100f;
    for (int i = 0; i < 4; i++)
        q[i] = ok ? q[i] / sqrtf(n) : i == 0 ? 1.0f : 0.0f;
}

/* E_q of an anchor directly from its numbers; of: index of a group of channels, 0 Sigma_v, 1 C_v, 2 + c chunk c of f_g. */
static inline int step_index(const adcgs_model *m, uint32_t anchor, uint32_t of)
{
    const adcgs_net *net = &m->net[ADCGS_ROLE_ENTROPY_STEPS];
    int32_t h[ADCGS_NET_WIDTH_MAX], acc[ADCGS_NET_WIDTH_MAX];
    for (uint32_t i = 0; i < m->params.n_fv; i++)
        h[i] = adcgs_clip(adcgs_shr(m->fv[(size_t)anchor * m->params.n_fv + i], net->in_shift), 2047);
    for (int l = 0; l < net->n_layers; l++) {
        const adcgs_layer *layer = &net->layer[l];
        for (uint32_t o = 0; o < layer->w.rows; o++) {
            acc[o] = layer->b.m[o];
            for (uint32_t i = 0; i < layer->w.cols; i++)
                acc[o] += layer->w.m[(size_t)o * layer->w.cols + i] * h[i];
            acc[o] = adcgs_shr(acc[o], layer->shift);
        }
        for (uint32_t o = 0; l + 1 < net->n_layers && o < layer->w.rows; o++) {
            const int32_t v = acc[o] < 0 ? adcgs_shr(acc[o], 6) : acc[o];
            h[o] = adcgs_clip(layer->residual ? h[o] + v : v, 2047);
        }
    }
    return adcgs_clip(acc[of], 16);
}

/* The value of a latent. Its step adapts to the anchor if the model has E_q. */
static inline float valued(const adcgs_model *m, uint32_t anchor, uint32_t of, int16_t yq, float d)
{
    const float factor = m->params.adaptive_steps ? adcgs_step_factor(step_index(m, anchor, of)) : 1.0f;
    const float step = d * factor;
    return (float)yq * step;
}

static inline void evaluate_prediction(const adcgs_model *m, uint32_t anchor, int k, float *out)
{
    const adcgs_net *net = &m->net[ADCGS_ROLE_PREDICTION];
    const adcgs_params *p = &m->params;
    const uint32_t slots = p->k > 1 ? p->k : 0;
    for (uint32_t o = 0; o < net->layer[0].w.rows; o++) {
        float sum = adcgs_tensor_value(&net->layer[0].b, o);
        for (uint32_t i = 0; i < p->n_fv; i++)
            sum = fmaf(weight(&net->layer[0], o, i), (float)m->fv[(size_t)anchor * p->n_fv + i] * m->d_fv[i], sum);
        if (slots)
            sum += weight(&net->layer[0], o, p->n_fv + (uint32_t)k);
        for (uint32_t i = 0; i < p->n_fg; i++)
            sum = fmaf(weight(&net->layer[0], o, p->n_fv + slots + i),
                       valued(m, anchor, 2 + i / (p->n_fg / p->chunks), m->fg[((size_t)anchor * p->k + (size_t)k) * p->n_fg + i],
                              m->d_fg[i]),
                       sum);
        out[o] = sum;
    }
    later_layers(net, out);
}

static inline void evaluate_time(const adcgs_model *m, float t, float *out)
{
    const adcgs_tensor *z = &m->net[ADCGS_ROLE_TIME].layer[0].w;
    const float u = t * (float)(z->rows - 1);
    uint32_t i = 0;
    while (i + 2 < z->rows && (float)(i + 1) <= u)
        i++;
    const float r = u - (float)i, s = 1 - r;
    for (uint32_t j = 0; j < z->cols; j++) {
        float row[4]; /* four rows, from the one before t's interval */
        for (uint32_t k = 0; k < 4; k++)
            row[k] = i + k > 0 && i + k <= z->rows ? adcgs_tensor_value(z, (size_t)(i + k - 1) * z->cols + j) : 0;
        if (z->rows == 1 || !m->params.smooth_time) {
            out[j] = z->rows == 1 ? row[1] : fmaf(r, row[2] - row[1], row[1]);
            continue;
        }
        if (i == 0)
            row[0] = 2 * row[1] - row[2];
        if (i + 2 == z->rows)
            row[3] = 2 * row[2] - row[1];
        float sum = s * s * s * (float)(1.0 / 6) * row[0];
        sum = fmaf(fmaf(r * r, 0.5f * r - 1, (float)(2.0 / 3)), row[1], sum);
        sum = fmaf(fmaf(s * s, 0.5f * s - 1, (float)(2.0 / 3)), row[2], sum);
        out[j] = fmaf(r * r * r * (float)(1.0 / 6), row[3], sum);
    }
}

static inline void evaluate_deformation(const adcgs_model *m, int role, uint32_t anchor, const float *time, float *out)
{
    const adcgs_net *net = &m->net[role];
    const adcgs_params *p = &m->params;
    float x[6 * ADCGS_OCTAVES_MAX + ADCGS_NV_MAX];
    uint32_t n = 0;
    if (role == ADCGS_ROLE_FINE)
        for (uint32_t a = 0; a < 3; a++)
            for (int o = 0; o < p->octaves; o++, n += 2)
                adcgs_sincospi(ldexpf((float)(2 * m->pos[3 * (size_t)anchor + a] + 1), o - m->depth - 1), &x[n], &x[n + 1]);
    if (role == ADCGS_ROLE_COARSE || p->fine_uses_fv)
        for (uint32_t i = 0; i < p->n_fv; i++)
            x[n++] = (float)m->fv[(size_t)anchor * p->n_fv + i] * m->d_fv[i];
    for (uint32_t o = 0; o < net->layer[0].w.rows; o++) {
        float still = 0.0f, moving = adcgs_tensor_value(&net->layer[0].b, o);
        for (uint32_t i = 0; i < n; i++)
            still = fmaf(weight(&net->layer[0], o, i), x[i], still);
        for (uint32_t i = 0; i < p->time_width; i++)
            moving = fmaf(weight(&net->layer[0], o, n + i), time[i], moving);
        out[o] = still + moving;
    }
    later_layers(net, out);
}

static inline void turn(const float r[4], float position[3], float offset[3], float q[4])
{
    const float w = r[0], x = r[1], y = r[2], z = r[3], x2 = x + x, y2 = y + y, z2 = z + z;
    const float m[9] = {fmaf(-y2, y, fmaf(-z2, z, 1.0f)), fmaf(x2, y, -(w * z2)), fmaf(x2, z, w * y2),    fmaf(x2, y, w * z2),
                        fmaf(-x2, x, fmaf(-z2, z, 1.0f)), fmaf(y2, z, -(w * x2)), fmaf(x2, z, -(w * y2)), fmaf(y2, z, w * x2),
                        fmaf(-x2, x, fmaf(-y2, y, 1.0f))};
    const float p[3] = {position[0], position[1], position[2]}, o[3] = {offset[0], offset[1], offset[2]};
    const float s[4] = {q[0], q[1], q[2], q[3]};
    for (int a = 0; a < 3; a++) {
        position[a] = fmaf(m[3 * a + 2], p[2], fmaf(m[3 * a + 1], p[1], m[3 * a] * p[0]));
        offset[a] = fmaf(m[3 * a + 2], o[2], fmaf(m[3 * a + 1], o[1], m[3 * a] * o[0]));
    }
    q[0] = fmaf(-z, s[3], fmaf(-y, s[2], fmaf(-x, s[1], w * s[0])));
    q[1] = fmaf(-z, s[2], fmaf(y, s[3], fmaf(x, s[0], w * s[1])));
    q[2] = fmaf(z, s[1], fmaf(y, s[0], fmaf(-x, s[3], w * s[2])));
    q[3] = fmaf(z, s[0], fmaf(-y, s[1], fmaf(x, s[2], w * s[3])));
}

/* The motion of an anchor from the middle of its lifetime; returns its presence. */
static inline float live(const adcgs_model *m, uint32_t anchor, float t, float position[3])
{
    float s[5];
    for (size_t c = 0; c < 5; c++)
        s[c] = valued(m, anchor, 0, m->sigma[11 * (size_t)anchor + 6 + c], m->d_sigma[6 + c]);
    const float since = t - fmaf(s[3], 0.125f, 0.5f), pace = adcgs_exp(adcgs_clampf(s[4], -8.0f, 8.0f));
    const float u = adcgs_clampf(since * pace, -4.0f, 4.0f), u2 = u * u, u4 = u2 * u2;
    for (int a = 0; a < 3; a++)
        position[a] = fmaf(s[a] * 0.125f, u, position[a]);
    return adcgs_exp(-u4);
}

/* The motion of an anchor's body: about the centre of the box of all its voxels in its first tier, then the translation. */
static inline void take_along(const adcgs_model *m, uint32_t anchor, const float *time, float position[3], float offset[3],
                              float q[4])
{
    const float *z = time + m->params.time_width + 7 * (m->body[anchor] - 1);
    float r[4] = {fmaf(z[0], 0.0625f, 1.0f), z[1] * 0.0625f, z[2] * 0.0625f, z[3] * 0.0625f}, centre[3];
    int tier = ADCGS_TIERS_MAX;
    normalise(r);
    for (uint32_t i = 0; i < m->n; i++)
        tier = m->body[i] == m->body[anchor] ? ADCGS_MIN(tier, m->tier[i]) : tier;
    for (size_t a = 0; a < 3; a++) {
        uint32_t low = UINT32_MAX, high = 0;
        for (uint32_t i = 0; i < m->n; i++)
            if (m->body[i] == m->body[anchor] && m->tier[i] == tier) {
                low = ADCGS_MIN(low, m->pos[3 * (size_t)i + a]);
                high = ADCGS_MAX(high, m->pos[3 * (size_t)i + a]);
            }
        centre[a] = fmaf((float)(low + high + 1), 0.5f * m->voxel, m->origin[a]);
        position[a] -= centre[a];
    }
    turn(r, position, offset, q);
    for (int a = 0; a < 3; a++)
        position[a] += centre[a] + z[4 + a] * 0.0625f;
}

static inline primitive evaluate(const adcgs_model *m, uint32_t anchor, int k, float t)
{
    float out[ADCGS_NET_WIDTH_MAX], coarse[ADCGS_NET_WIDTH_MAX], fine[ADCGS_NET_WIDTH_MAX];
    float time[ADCGS_TIME_WIDTH_MAX + ADCGS_BODIES_MAX * ADCGS_POSE_N];
    float position[3], offset[3], q[4];
    primitive r;
    const int moves = m->params.time_rows > 0 && !m->is_static[anchor];
    const int has_coarse = moves && m->net[ADCGS_ROLE_COARSE].present, has_fine = moves && m->net[ADCGS_ROLE_FINE].present;
    const size_t first = (m->params.spans ? 11 : 6) * (size_t)anchor;
    evaluate_prediction(m, anchor, k, out);
    if (moves)
        evaluate_time(m, t, time);
    if (has_coarse)
        evaluate_deformation(m, ADCGS_ROLE_COARSE, anchor, time, coarse);
    if (has_fine)
        evaluate_deformation(m, ADCGS_ROLE_FINE, anchor, time, fine);
    float logit = out[13];
    for (int a = 0; a < 3; a++) {
        const float extent = valued(m, anchor, 0, m->sigma[first + (size_t)a], m->d_sigma[a]);
        const float size = valued(m, anchor, 0, m->sigma[first + 3 + (size_t)a], m->d_sigma[3 + a]);
        position[a] = fmaf((float)(2 * m->pos[3 * (size_t)anchor + (size_t)a] + 1), 0.5f * m->voxel, m->origin[a]);
        offset[a] = out[a] * adcgs_exp(adcgs_clampf(extent, -16.0f, 8.0f));
        r.v[3 + a] = adcgs_exp(adcgs_clampf(size, -16.0f, 8.0f)) * adcgs_sigmoid(out[3 + a]);
        r.v[11 + a] = valued(m, anchor, 1, m->colour[3 * (size_t)anchor + (size_t)a], m->d_colour[a]) + out[10 + a];
    }
    for (int a = 0; a < 4; a++)
        q[a] = out[6 + a] + (a == 0 ? 1.0f : 0.0f);
    normalise(q);
    if (has_coarse) {
        float turned[4] = {1.0f, coarse[9], coarse[10], coarse[11]};
        normalise(turned);
        if (m->params.coarse_rotation)
            turn(turned, position, offset, q);
        for (int a = 0; a < 3; a++) {
            position[a] += coarse[a];
            r.v[3 + a] *= adcgs_exp(adcgs_clampf(coarse[3 + a], -8.0f, 8.0f));
            r.v[11 + a] += coarse[6 + a];
        }
    }
    const float presence = moves && m->params.spans ? live(m, anchor, t, position) : 1.0f;
    if (m->body[anchor])
        take_along(m, anchor, time, position, offset, q);
    if (has_fine) {
        logit += fine[4 * k];
        for (int a = 0; a < 3; a++)
            r.v[11 + a] += fine[4 * k + 1 + a];
    }
    for (int a = 0; a < 3; a++) {
        r.v[a] = adcgs_clampf(position[a] + offset[a], -0x1p15f, 0x1p15f);
        r.v[3 + a] = adcgs_clampf(r.v[3 + a], 0x1p-20f, 0x1p10f);
        r.v[11 + a] = adcgs_clampf(r.v[11 + a], -0x1p8f, 0x1p8f);
    }
    memcpy(r.v + 6, q, sizeof q);
    r.v[10] = 0.99f * adcgs_sigmoid(logit) * presence;
    return r;
}

#endif
