/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The passes of training in binary64, value by value: primitives and bits of a float model. */
#ifndef ADCGS_TESTS_TRAIN_REFERENCE_H
#define ADCGS_TESTS_TRAIN_REFERENCE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fmodel/fmodel.h"

#include <math.h>

enum { K = 3, NV = 5, NG = 4, CHUNKS = 2, ETA = 2, OCTAVES = 2, ANCHORS = 70, VALUES = 14 };

/** Evaluates a network on one sample in binary64 straight from the parameters. */
static inline void ref_mlp(const adcgs_mlp *m, const float *p, const double *x, double *out)
{
    double h[64], a[64];
    const int inputs = m->own + m->time;
    memcpy(h, x, (size_t)inputs * sizeof *x);
    for (int i = 0; i <= m->hidden; i++) {
        for (int o = 0; o < m->n_out[i]; o++) {
            a[o] = p[m->b[i] + (size_t)o];
            for (int j = 0; j < m->in[i]; j++)
                a[o] += p[m->w[i] + (size_t)(o * m->in[i] + j)] * h[j];
        }
        for (int o = 0; o < m->n_out[i]; o++) {
            if (i == m->hidden)
                out[o] = a[o];
            else
                h[o] = (a[o] < 0 ? a[o] / 64 : a[o]) + (i > 0 ? h[o] : 0);
        }
    }
}

/** The noise that a test's forward pass added, in steps. Without noise, steps do not adapt. */
static int noisy;
static float *noise[ADCGS_P_ANCHOR];

static inline double noise_at(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    return noise[group][((size_t)(anchor / 64) * rows + (size_t)row) * 64 + anchor % 64];
}

/** The factor of a step: 2 to the power of E_q's output for the f_v that the networks see, within two octaves. */
static inline double factor_of(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    double x[64], out[64];
    const int of = group == ADCGS_P_SIGMA ? 0 : group == ADCGS_P_COLOUR ? 1 : 2 + row % NG / (NG / CHUNKS);
    if (!noisy || group == ADCGS_P_FV || group == ADCGS_P_ETA)
        return 1;
    for (int i = 0; i < NV; i++) {
        const double step = f->step[ADCGS_P_FV][i];
        x[i] = (*adcgs_fmodel_at(f, ADCGS_P_FV, anchor, i) + step * noise_at(f, ADCGS_P_FV, anchor, i)) / (16 * step);
    }
    ref_mlp(&f->mlp[ADCGS_P_E_STEPS], f->param[ADCGS_P_E_STEPS].p, x, out);
    return pow(2, fmin(fmax(out[of], -2), 2));
}

static inline double step_of(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    return f->step[group][row] * factor_of(f, group, anchor, row);
}

static inline double value(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    const double y = *adcgs_fmodel_at(f, group, anchor, row);
    return noisy ? y + step_of(f, group, anchor, row) * noise_at(f, group, anchor, row) : y;
}

static inline double place(const adcgs_fmodel *f, uint32_t anchor, int axis)
{
    return f->x[((size_t)(anchor / 64) * 3 + (size_t)axis) * 64 + anchor % 64];
}

static inline double sigmoid(double x)
{
    return 1 / (1 + exp(-x));
}

static inline void product(const double a[4], const double b[4], double c[4])
{
    c[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    c[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    c[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    c[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static inline void normalise(double q[4])
{
    const double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] /= n;
}

static inline void time_code(const adcgs_fmodel *f, double t, double *code)
{
    const int rows = f->params.time_rows, width = f->params.time_width, columns = width + 7 * f->params.bodies;
    const double u = t * (rows - 1);
    const float *z = f->param[ADCGS_P_TIME].p;
    for (int j = 0; j < columns; j++) {
        code[j] = 0;
        for (int i = -1; i <= rows; i++) { /* cubic B-spline about row i, by distance; rows beyond the ends continue linearly */
            const double first = (double)z[j], last = (double)z[(rows - 1) * columns + j], d = fabs(u - i);
            const double row = i < 0       ? 2 * first - (double)z[columns + j]
                               : i == rows ? 2 * last - (double)z[(rows - 2) * columns + j]
                                           : (double)z[i * columns + j];
            const double smooth = d < 1 ? 2.0 / 3 - d * d + d * d * d / 2 : d < 2 ? pow(2 - d, 3) / 6 : 0;
            code[j] += row * (f->params.smooth_time ? smooth : fmax(1 - d, 0));
        }
    }
}

/** Rotates v by a unit quaternion. */
static inline void turn(const double q[4], const double v[3], double out[3])
{
    const double conj[4] = {q[0], -q[1], -q[2], -q[3]}, pure[4] = {0, v[0], v[1], v[2]};
    double turned[4], back[4];
    product(q, pure, turned);
    product(turned, conj, back);
    memcpy(out, back + 1, 3 * sizeof *out);
}

/** Applies the motion of an anchor's body to its primitive. */
static inline void ref_body(const adcgs_fmodel *f, uint32_t anchor, double t, double mean[3], double rotation[4])
{
    double code[64], q[4], v[3], own[4];
    const int body = f->moving[anchor] == 0 ? 0 : f->body[anchor];
    if (!body)
        return;
    time_code(f, t, code);
    const double *z = code + f->params.time_width + 7 * (body - 1);
    for (int i = 0; i < 4; i++)
        q[i] = z[i] / 16 + !i;
    normalise(q);
    for (int a = 0; a < 3; a++)
        v[a] = mean[a] - f->centre[body - 1][a];
    turn(q, v, mean);
    for (int a = 0; a < 3; a++)
        mean[a] += f->centre[body - 1][a] + z[4 + a] / 16;
    memcpy(own, rotation, sizeof own);
    product(q, own, rotation);
}

/** The output of F_omega for an anchor at time t; zero for a static anchor. */
static inline void ref_omega(const adcgs_fmodel *f, uint32_t anchor, double t, double om[12])
{
    double x[128];
    for (int i = 0; i < NV; i++)
        x[i] = value(f, ADCGS_P_FV, anchor, i);
    time_code(f, t, x + NV);
    ref_mlp(&f->mlp[ADCGS_P_OMEGA], f->param[ADCGS_P_OMEGA].p, x, om);
    for (int i = 0; i < 12; i++)
        om[i] *= f->moving[anchor];
}

/** An anchor's place in its lifetime at time t: -1 to 1 while it is well visible; 0 without a lifetime. */
static inline double ref_span(const adcgs_fmodel *f, uint32_t anchor, double t)
{
    if (!f->params.spans || f->moving[anchor] == 0)
        return 0;
    const double middle = 0.5 + 0.125 * value(f, ADCGS_P_SIGMA, anchor, 9);
    return fmin(fmax((t - middle) * exp(fmin(fmax(value(f, ADCGS_P_SIGMA, anchor, 10), -8), 8)), -4), 4);
}

/** Primitive k of an anchor at time t: mean 3, scale 3, rotation 4, opacity, colour 3. */
static inline void ref_primitive(const adcgs_fmodel *f, uint32_t anchor, int k, double t, double out[VALUES])
{
    double x[64], th[14], om[12], va[4 * K], q0[4], qr[4], q[4], off[4] = {0}, turned[4], back[4];
    for (int i = 0; i < NV; i++)
        x[i] = value(f, ADCGS_P_FV, anchor, i);
    for (int i = 0; i < K; i++)
        x[NV + i] = i == k;
    for (int i = 0; i < NG; i++)
        x[NV + K + i] = value(f, ADCGS_P_FG, anchor, k * NG + i);
    ref_mlp(&f->mlp[ADCGS_P_THETA], f->param[ADCGS_P_THETA].p, x, th);
    ref_omega(f, anchor, t, om);
    double y[128];
    for (int i = 0; i < 6 * OCTAVES; i++)
        y[i] = f->code[((size_t)(anchor / 64) * 6 * OCTAVES + (size_t)i) * 64 + anchor % 64];
    memcpy(y + 6 * OCTAVES, x, NV * sizeof *x);
    time_code(f, t, y + 6 * OCTAVES + NV);
    ref_mlp(&f->mlp[ADCGS_P_VARPI], f->param[ADCGS_P_VARPI].p, y, va);
    const double moving = f->moving[anchor], u = ref_span(f, anchor, t);
    qr[0] = 1;
    q0[0] = th[6] + 1;
    for (int a = 0; a < 3; a++) {
        qr[1 + a] = om[9 + a];
        q0[1 + a] = th[7 + a];
        off[1 + a] = th[a] * exp(value(f, ADCGS_P_SIGMA, anchor, a)) + place(f, anchor, a);
    }
    normalise(qr);
    normalise(q0);
    product(qr, q0, q);
    const double conj[4] = {qr[0], -qr[1], -qr[2], -qr[3]};
    product(qr, off, turned);
    product(turned, conj, back);
    for (int a = 0; a < 3; a++) {
        out[a] = om[a] + back[1 + a] + (u != 0 ? 0.125 * u * value(f, ADCGS_P_SIGMA, anchor, 6 + a) : 0);
        out[3 + a] = exp(value(f, ADCGS_P_SIGMA, anchor, 3 + a)) * sigmoid(th[3 + a]) * exp(om[3 + a]);
        out[11 + a] = value(f, ADCGS_P_COLOUR, anchor, a) + th[10 + a] + om[6 + a] + moving * va[4 * k + 1 + a];
    }
    memcpy(out + 6, q, sizeof q);
    ref_body(f, anchor, t, out, out + 6);
    const double there = exp(-u * u * u * u) * f->keep[((size_t)(anchor / 64) * K + (size_t)k) * 64 + anchor % 64];
    out[10] = 0.99 * sigmoid(th[13] + moving * va[4 * k]) * there;
}

static inline double gauss_cdf(double x)
{
    return 0.5 * erfc(-x / sqrt(2));
}

/** Bits of value y under a network's outputs, as the trainer defines them. */
static inline double ref_bits(double y, double step, double mu, double si)
{
    const double v = y / step - 16 * mu, level = fmin(fmax(8 * si + 32, 0), 63);
    const double sigma = 0.11 * pow(64 / 0.11, level / 63), width = 1 + 4 * sigma;
    const double inside = gauss_cdf((v + 0.5) / sigma) - gauss_cdf((v - 0.5) / sigma);
    return -log2(inside * (1 - ldexp(1, -12)) + ldexp(width / (width * width + v * v), -14) + 1e-12);
}

static inline double ref_rows(const adcgs_fmodel *f, int net, const double *x, int group, uint32_t anchor, int first, int rows)
{
    double out[64], bits = 0;
    ref_mlp(&f->mlp[net], f->param[net].p, x, out);
    for (int i = 0; i < rows; i++)
        bits += ref_bits(value(f, group, anchor, first + i), step_of(f, group, anchor, first + i), out[i],
                         out[f->mlp[net].out / 2 + i]);
    return bits;
}

static inline double ref_rate(const adcgs_fmodel *f)
{
    double bits = 0, x[64];
    for (uint32_t a = 0; a < f->n; a++) {
        const float *prior = f->param[ADCGS_P_ETA_PRIOR].p;
        for (int i = 0; i < ETA; i++) {
            bits += ref_bits(value(f, ADCGS_P_ETA, a, i), 1, prior[i], prior[ETA + i]);
            x[i] = value(f, ADCGS_P_ETA, a, i) / 16;
        }
        bits += ref_rows(f, ADCGS_P_E_FV, x, ADCGS_P_FV, a, 0, NV);
        for (int i = 0; i < NV; i++)
            x[i] = value(f, ADCGS_P_FV, a, i) / (16.0 * f->step[ADCGS_P_FV][i]);
        bits += ref_rows(f, ADCGS_P_E_SIGMA, x, ADCGS_P_SIGMA, a, 0, f->params.spans && f->moving[a] != 0 ? 11 : 6);
        bits += ref_rows(f, ADCGS_P_E_COLOUR, x, ADCGS_P_COLOUR, a, 0, 3);
        for (int k = 0; k < K; k++) {
            if (f->keep[((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64] == 0)
                continue;
            for (int i = 0; i < NG; i++)
                x[NV + i] = value(f, ADCGS_P_FG, a, k * NG + i) / (16.0 * step_of(f, ADCGS_P_FG, a, k * NG + i));
            for (int c = 0; c < CHUNKS; c++)
                bits += ref_rows(f, ADCGS_P_E_FG + c, x, ADCGS_P_FG, a, k * NG + c * NG / CHUNKS, NG / CHUNKS);
        }
    }
    return bits;
}

#endif
