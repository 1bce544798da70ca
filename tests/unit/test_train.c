/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The trainer's passes against an independent reference in binary64: values of primitives and bits, and every gradient against
 * central differences.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fmodel/body_trajectories.h"
#include "fmodel/pass.h"
#include "fmodel/rigidity.h"
#include "fmodel/scale_penalty.h"
#include "grad/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { K = 3, NV = 5, NG = 4, CHUNKS = 2, ETA = 2, OCTAVES = 2, ANCHORS = 70, VALUES = 14 };

/* ---- Reference ---- */

/** Evaluates a network on one sample in binary64 straight from the parameters. */
static void ref_mlp(const adcgs_mlp *m, const float *p, const double *x, double *out)
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

static double noise_at(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    return noise[group][((size_t)(anchor / 64) * rows + (size_t)row) * 64 + anchor % 64];
}

/** The factor of a step: 2 to the power of E_q's output for the f_v that the networks see, within two octaves. */
static double factor_of(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
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

static double step_of(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    return f->step[group][row] * factor_of(f, group, anchor, row);
}

static double value(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    const double y = *adcgs_fmodel_at(f, group, anchor, row);
    return noisy ? y + step_of(f, group, anchor, row) * noise_at(f, group, anchor, row) : y;
}

static double place(const adcgs_fmodel *f, uint32_t anchor, int axis)
{
    return f->x[((size_t)(anchor / 64) * 3 + (size_t)axis) * 64 + anchor % 64];
}

static double sigmoid(double x)
{
    return 1 / (1 + exp(-x));
}

static void product(const double a[4], const double b[4], double c[4])
{
    c[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    c[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    c[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    c[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

static void normalise(double q[4])
{
    const double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] /= n;
}

static void time_code(const adcgs_fmodel *f, double t, double *code)
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
static void turn(const double q[4], const double v[3], double out[3])
{
    const double conj[4] = {q[0], -q[1], -q[2], -q[3]}, pure[4] = {0, v[0], v[1], v[2]};
    double turned[4], back[4];
    product(q, pure, turned);
    product(turned, conj, back);
    memcpy(out, back + 1, 3 * sizeof *out);
}

/** Applies the motion of an anchor's body to its primitive. */
static void ref_body(const adcgs_fmodel *f, uint32_t anchor, double t, double mean[3], double rotation[4])
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
static void ref_omega(const adcgs_fmodel *f, uint32_t anchor, double t, double om[12])
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
static double ref_span(const adcgs_fmodel *f, uint32_t anchor, double t)
{
    if (!f->params.spans || f->moving[anchor] == 0)
        return 0;
    const double middle = 0.5 + 0.125 * value(f, ADCGS_P_SIGMA, anchor, 9);
    return fmin(fmax((t - middle) * exp(fmin(fmax(value(f, ADCGS_P_SIGMA, anchor, 10), -8), 8)), -4), 4);
}

/** Primitive k of an anchor at time t: mean 3, scale 3, rotation 4, opacity, colour 3. */
static void ref_primitive(const adcgs_fmodel *f, uint32_t anchor, int k, double t, double out[VALUES])
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

static double gauss_cdf(double x)
{
    return 0.5 * erfc(-x / sqrt(2));
}

/** Bits of value y under a network's outputs, as the trainer defines them. */
static double ref_bits(double y, double step, double mu, double si)
{
    const double v = y / step - 16 * mu, level = fmin(fmax(8 * si + 32, 0), 63);
    const double sigma = 0.11 * pow(64 / 0.11, level / 63), width = 1 + 4 * sigma;
    const double inside = gauss_cdf((v + 0.5) / sigma) - gauss_cdf((v - 0.5) / sigma);
    return -log2(inside * (1 - ldexp(1, -12)) + ldexp(width / (width * width + v * v), -14) + 1e-12);
}

static double ref_rows(const adcgs_fmodel *f, int net, const double *x, int group, uint32_t anchor, int first, int rows)
{
    double out[64], bits = 0;
    ref_mlp(&f->mlp[net], f->param[net].p, x, out);
    for (int i = 0; i < rows; i++)
        bits += ref_bits(value(f, group, anchor, first + i), step_of(f, group, anchor, first + i), out[i],
                         out[f->mlp[net].out / 2 + i]);
    return bits;
}

static double ref_rate(const adcgs_fmodel *f)
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

/* ---- The model under test ---- */

typedef struct fixture {
    adcgs_fmodel *f;
    adcgs_pass *pass;
} fixture;

static void randomise(float *p, size_t n, double size, uint64_t stream)
{
    for (size_t i = 0; i < n; i++)
        p[i] += (float)(size * adcgs_random_normal(7, stream, i));
}

/** Lifetimes all over the segment and beyond it. Some are so far away that their times have no gradient. */
static void spread_lives(adcgs_fmodel *f)
{
    for (uint32_t a = 0; a < f->n; a++) {
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, a, ADCGS_SPAN_MIDDLE) = 8 * ((float)(a % 13) / 10 - 0.6f);
        *adcgs_fmodel_at(f, ADCGS_P_SIGMA, a, ADCGS_SPAN_PACE) = a == 8 ? 9.0f : (float)(a % 7) / 3 - 0.5f;
    }
}

/** The state is a CPU level, optionally with WITH_SPANS, which adds lifetimes and bodies. */
enum { WITH_SPANS = 16 };

/** Two bodies, with anchors of no body among theirs. */
static void spread_bodies(adcgs_fmodel *f)
{
    const size_t columns = (size_t)adcgs_fmodel_time_columns(&f->params), width = f->params.time_width;
    for (uint32_t a = 0; a < f->n; a++)
        f->body[a] = (uint8_t)(a % 3);
    for (size_t r = 0; r < f->params.time_rows; r++)
        randomise(f->param[ADCGS_P_TIME].p + r * columns + width, columns - width, 8, 99 + r);
    adcgs_bodies_recentre(f);
}

static int setup(void **state)
{
    const int spans = (uintptr_t)*state >= WITH_SPANS;
    const adcgs_params params = {.k = K,
                                 .n_fv = NV,
                                 .n_fg = NG,
                                 .chunks = CHUNKS,
                                 .n_eta = ETA,
                                 .octaves = OCTAVES,
                                 .fine_uses_fv = 1,
                                 .coarse_rotation = 1,
                                 .adaptive_steps = 1,
                                 .spans = (uint8_t)spans,
                                 .bodies = spans ? 2 : 0,
                                 .smooth_time = (uint8_t)spans,
                                 .time_rows = 4,
                                 .time_width = 3};
    const adcgs_shape shape = {.theta_width = 6,
                               .theta_hidden = 2,
                               .omega_width = 5,
                               .omega_hidden = 3,
                               .varpi_width = 6,
                               .varpi_hidden = 2,
                               .entropy_width = 6,
                               .entropy_hidden = 2,
                               .step_fv = 0.1f,
                               .step_fg = 0.2f,
                               .step_sigma = 0.1f,
                               .step_colour = 0.05f,
                               .depth = 8};
    const float origin[3] = {-1, -1, -1};
    static uint32_t pos[ANCHORS][3];
    for (uint32_t i = 0; i < ANCHORS; i++)
        pos[i][0] = i, pos[i][1] = 3 * i % 200, pos[i][2] = 7 * i % 200;
    fixture *x = calloc(1, sizeof *x);
    adcgs_error error;
    assert_int_equal(adcgs_fmodel_create(&x->f, &params, &shape, origin, 1.0f / 128, (const uint32_t(*)[3])pos, ANCHORS, 3,
                                         &error),
                     ADCGS_OK);
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        randomise(x->f->param[i].p, x->f->param[i].n, i < ADCGS_P_ANCHOR ? 0.4 : 0.15, (uint64_t)i);
    x->f->moving[5] = 0;
    if (spans)
        spread_bodies(x->f);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        if (x->f->mlp[i].n)
            adcgs_mlp_prepare(&x->f->mlp[i], x->f->param[i].p, 0);
    }
    adcgs_fmodel_take_steps(x->f);
    if (spans)
        spread_lives(x->f);
    x->f->keep[1 * 64 + 9] = 0;
    const adcgs_cpu_level level = (adcgs_cpu_level)((uintptr_t)*state % WITH_SPANS);
    assert_int_equal(adcgs_pass_create(&x->pass, x->f, level, NULL, &error), ADCGS_OK);
    *state = x;
    return 0;
}

static int teardown(void **state)
{
    fixture *x = *state;
    adcgs_pass_free(&x->pass);
    adcgs_fmodel_free(&x->f);
    free(x);
    return 0;
}

/** A fixed random weight for value v of a slot. The tested gradient is that of the weighted sum of all primitives. */
static double weight_of(size_t slot, int v)
{
    return adcgs_random_normal(11, (uint64_t)v, slot);
}

static double ref_sum(const adcgs_fmodel *f, double t)
{
    double sum = 0, p[VALUES];
    for (uint32_t a = 0; a < f->n; a++)
        for (int k = 0; k < K; k++) {
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            ref_primitive(f, a, k, t, p);
            for (int v = 0; v < VALUES; v++)
                sum += weight_of(slot, v) * p[v];
        }
    return sum;
}

static void test_forward(void **state)
{
    const fixture *x = *state;
    const size_t slots = x->pass->primitives.n;
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++) {
            double p[VALUES];
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            ref_primitive(x->f, a, k, 0.4f, p);
            for (int v = 0; v < VALUES; v++)
                assert_float_equal(x->pass->prim[(size_t)v * slots + slot], p[v], 2e-5 * (1 + fabs(p[v])));
        }
}

/** A pass that changes the time alone gives the same result as a whole one. */
static void test_other_time(void **state)
{
    const fixture *x = *state;
    const size_t bytes = ADCGS_ROWS * (size_t)x->pass->primitives.n * sizeof(float);
    float *whole = malloc(bytes);
    assert_non_null(whole);
    adcgs_pass_forward(x->pass, x->f, 0.7f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    memcpy(whole, x->pass->prim, bytes);
    adcgs_pass_forward(x->pass, x->f, 0.2f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    assert_memory_not_equal(whole, x->pass->prim, bytes);
    adcgs_pass_forward(x->pass, x->f, 0.7f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL, .other_time = 1});
    assert_memory_equal(whole, x->pass->prim, bytes);
    free(whole);
}

typedef double (*scalar_fn)(const adcgs_fmodel *f);

static double distortion(const adcgs_fmodel *f)
{
    return ref_sum(f, 0.4f);
}

/** Compares gradients of a sample of each group's parameters with central differences of fn. */
static void check_gradients(adcgs_fmodel *f, scalar_fn fn, int first_group)
{
    for (int g = first_group; g < ADCGS_P_COUNT; g++) {
        const adcgs_param *p = &f->param[g];
        double size = 0;
        for (size_t i = 0; i < p->n; i++)
            size = fmax(size, fabs(p->g[i]));
        if (!p->n)
            continue;
        for (int trial = 0; trial < 24; trial++) {
            const size_t i = (size_t)(adcgs_random_unit(5, (uint64_t)g, (uint64_t)trial) * (double)p->n);
            const float keep = p->p[i], h = g == ADCGS_P_STEP ? 1e-3f : 1e-4f;
            p->p[i] = keep + h;
            adcgs_fmodel_take_steps(f);
            const double hi = p->p[i], up = fn(f);
            p->p[i] = keep - h;
            adcgs_fmodel_take_steps(f);
            const double lo = p->p[i], down = fn(f);
            p->p[i] = keep;
            adcgs_fmodel_take_steps(f);
            const double want = (up - down) / (hi - lo);
            if (fabs(p->g[i] - want) > 2e-3 * size + 1e-3 * fabs(want))
                fail_msg("%s[%zu]: gradient %g, differences %g (largest %g)", p->name, i, (double)p->g[i], want, size);
        }
    }
}

static void clear_gradients(adcgs_fmodel *f)
{
    for (int g = 0; g < ADCGS_P_COUNT; g++)
        memset(f->param[g].g, 0, f->param[g].n * sizeof(float));
}

static void test_distortion_gradients(void **state)
{
    const fixture *x = *state;
    const size_t slots = x->pass->primitives.n;
    clear_gradients(x->f);
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    memset(x->pass->grad, 0, 16 * slots * sizeof(float));
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++) {
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            for (int v = 0; v < VALUES; v++)
                x->pass->grad[(size_t)v * slots + slot] = (float)weight_of(slot, v);
        }
    adcgs_pass_backward(x->pass, x->f, ADCGS_DEFORM_ALL, 0, 0, 0, NULL);
    check_gradients(x->f, distortion, 0);
}

/** A group of static anchors skips the deformation networks; values and gradients are correct. */
static void test_still_group(void **state)
{
    const fixture *x = *state;
    memset(x->f->moving, 0, 64 * sizeof *x->f->moving);
    test_forward(state);
    test_distortion_gradients(state);
}

static void test_rate_gradients(void **state)
{
    const fixture *x = *state;
    adcgs_rate rate;
    clear_gradients(x->f);
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    memset(x->pass->grad, 0, 16 * (size_t)x->pass->primitives.n * sizeof(float));
    adcgs_pass_backward(x->pass, x->f, ADCGS_DEFORM_ALL, 1, 1, 0, &rate);
    assert_float_equal(rate.total, ref_rate(x->f), 5e-6 * rate.total);
    for (int g = ADCGS_P_E_FV; g < ADCGS_P_E_FG + CHUNKS; g++)
        for (size_t i = x->f->mlp[g].b[x->f->mlp[g].hidden]; i < x->f->param[g].n; i++)
            assert_true(x->f->param[g].g[i] != 0); /* a nonzero gradient into every entropy network */
    check_gradients(x->f, ref_rate, 0);
}

/** Weighted sum of the primitives of a pass with noise. */
static double noisy_sum(const fixture *x)
{
    const size_t slots = x->pass->primitives.n;
    double sum = 0;
    adcgs_pass_forward(x->pass, x->f, 0.4f,
                       &(adcgs_pass_mode){.quant = ADCGS_QUANT_NOISE, .deform = ADCGS_DEFORM_ALL, .seed = 5});
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++) {
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            for (int v = 0; v < VALUES; v++)
                sum += weight_of(slot, v) * (double)x->pass->prim[(size_t)v * slots + slot];
        }
    return sum;
}

/** The part of the steps' gradient that comes from the images, through the noise. A tiny weight of the rate switches it on. */
static void test_step_gradients(void **state)
{
    const fixture *x = *state;
    adcgs_param *p = &x->f->param[ADCGS_P_STEP];
    adcgs_rate rate;
    noisy_sum(x);
    memset(x->pass->grad, 0, 16 * (size_t)x->pass->primitives.n * sizeof(float));
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++)
            for (int v = 0; v < VALUES; v++) {
                const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
                x->pass->grad[(size_t)v * x->pass->primitives.n + slot] = (float)weight_of(slot, v);
            }
    clear_gradients(x->f);
    adcgs_pass_backward(x->pass, x->f, ADCGS_DEFORM_ALL, 1e-12f, 1, 0, &rate);
    double size = 0;
    for (size_t i = 0; i < p->n; i++)
        size = fmax(size, fabs(p->g[i]));
    for (size_t i = 0; i < p->n; i++) {
        const float keep = p->p[i], h = 1e-3f, got = p->g[i];
        p->p[i] = keep + h;
        adcgs_fmodel_take_steps(x->f);
        const double up = noisy_sum(x);
        p->p[i] = keep - h;
        adcgs_fmodel_take_steps(x->f);
        const double want = (up - noisy_sum(x)) / (2 * (double)h);
        p->p[i] = keep;
        adcgs_fmodel_take_steps(x->f);
        if (fabs(got - want) > 1e-2 * size)
            fail_msg("step %zu: gradient %g, differences %g (largest %g)", i, (double)got, want, size);
    }
}

/** Moves a place by the motion that F_omega gives. */
static void ref_motion(const double om[12], const double place[3], double out[3])
{
    double q[4] = {1, om[9], om[10], om[11]}, v[4] = {0, place[0], place[1], place[2]}, turned[4], back[4];
    normalise(q);
    const double conj[4] = {q[0], -q[1], -q[2], -q[3]};
    product(q, v, turned);
    product(turned, conj, back);
    for (int a = 0; a < 3; a++)
        out[a] = back[1 + a] + om[a];
}

/** The rigidity energy between neighbours, by its definition, in double. */
static double ref_rigid(const adcgs_rigidity *rigid, const adcgs_fmodel *f, double t)
{
    double energy = 0, om[ANCHORS][12];
    for (uint32_t i = 0; i < f->n; i++)
        ref_omega(f, i, t, om[i]);
    for (uint32_t i = 0; i < f->n; i++)
        for (int k = 0; k < ADCGS_RIGIDITY_NEAR; k++) {
            double y[3], by_i[3], by_j[3], length = 0, stretch = 0;
            if (rigid->near[i][k] < 0)
                continue;
            const uint32_t j = (uint32_t)rigid->near[i][k];
            if (f->moving[i] == 0 || f->moving[j] == 0)
                continue;
            for (int a = 0; a < 3; a++) {
                y[a] = place(f, j, a);
                length += pow(y[a] - place(f, i, a), 2);
            }
            ref_motion(om[i], y, by_i);
            ref_motion(om[j], y, by_j);
            for (int a = 0; a < 3; a++)
                stretch += pow(by_i[a] - by_j[a], 2);
            energy += 0.05 * log(1 + stretch / length / (0.05 * 0.05));
        }
    return energy / ADCGS_RIGIDITY_NEAR / f->n;
}

static const adcgs_rigidity *rigid_under_test;

static double rigid_energy(const adcgs_fmodel *f)
{
    return ref_rigid(rigid_under_test, f, 0.4f);
}

/** The k-th anchor to i by key, then number. The key is the distance or, if drawn, a random number of those within reach. */
static int32_t near_by_search(const adcgs_fmodel *f, uint32_t i, int drawn, int k)
{
    const double reach = (double)ADCGS_RIGIDITY_REACH / (double)f->voxel;
    uint8_t taken[ANCHORS] = {0};
    int32_t best = -1;
    for (int turn = 0; turn <= k; turn++) {
        uint64_t least = UINT64_MAX;
        best = -1;
        for (uint32_t j = 0; j < ANCHORS; j++) {
            uint64_t d = 0;
            for (int a = 0; a < 3; a++)
                d += (uint64_t)(((int64_t)f->pos[i][a] - f->pos[j][a]) * ((int64_t)f->pos[i][a] - f->pos[j][a]));
            const uint64_t key = drawn ? adcgs_random64(1, i, j) : d;
            if (j == i || taken[j] || (drawn && (double)d >= reach * reach) || key >= least)
                continue;
            least = key;
            best = (int32_t)j;
        }
        if (best >= 0)
            taken[best] = 1;
    }
    return best;
}

/** The neighbours equal those of an exhaustive search. */
static void test_neighbours(void **state)
{
    const fixture *x = *state;
    adcgs_rigidity rigid = {0};
    adcgs_error error;
    assert_int_equal(adcgs_rigidity_build(&rigid, x->f, NULL, &error), ADCGS_OK);
    for (uint32_t i = 0; i < ANCHORS; i++)
        for (int k = 0; k < ADCGS_RIGIDITY_NEAR; k++) {
            const int drawn = k >= ADCGS_RIGIDITY_CLOSE;
            assert_int_equal(rigid.near[i][k], near_by_search(x->f, i, drawn, drawn ? k - ADCGS_RIGIDITY_CLOSE : k));
        }
    adcgs_rigidity_clear(&rigid);
}

static void test_rigid(void **state)
{
    const fixture *x = *state;
    adcgs_rigidity rigid = {0};
    adcgs_error error;
    assert_int_equal(adcgs_rigidity_build(&rigid, x->f, NULL, &error), ADCGS_OK);
    rigid_under_test = &rigid;
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){.deform = ADCGS_DEFORM_ALL});
    clear_gradients(x->f);
    memset(x->pass->grad, 0, 16 * (size_t)x->pass->primitives.n * sizeof(float));
    assert_float_equal(adcgs_rigidity_pull(&rigid, x->pass, x->f, 1), rigid_energy(x->f), 1e-5);
    x->pass->pull = rigid.pull;
    adcgs_pass_backward(x->pass, x->f, ADCGS_DEFORM_ALL, 0, 0, 0, NULL);
    x->pass->pull = NULL;
    check_gradients(x->f, rigid_energy, 0);
    adcgs_rigidity_clear(&rigid);
}

/** Price of size: its value and gradient against a calculation by hand. Invisible primitives have neither. */
static void test_area(void **state)
{
    static const float sd[3][4] = {{1, 2, 5, 0.5f}, {2, 3, 7, 0.25f}, {4, 1, 9, 1}};
    static const float opacity[4] = {0.5f, 0.25f, 0, 0.99f};
    const float *const s[3] = {sd[0], sd[1], sd[2]};
    const adcgs_primitives primitives = {.n = 4, .scale = {sd[0], sd[1], sd[2]}, .opacity = opacity};
    float g[3][4] = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    double area = 0;
    for (int i = 0; i < 4; i++)
        area += i == 2 ? 0 : (double)(s[0][i] * s[1][i] + s[1][i] * s[2][i] + s[2][i] * s[0][i]);
    float *const to[3] = {g[0], g[1], g[2]};
    const double price = adcgs_scale_penalty(&primitives, &(adcgs_viewpoints){.n = 0}, 0.5f, to);
    assert_float_equal(price, 0.5 * area / 9, 1e-6);
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 4; i++)
            assert_float_equal(g[a][i], i == 2 ? 1 : 1 + 0.5f / 9 * (s[(a + 1) % 3][i] + s[(a + 2) % 3][i]), 1e-6);
}

/** The same with viewpoints, which include places between cameras: a closer primitive counts as larger. */
static void test_area_seen(void **state)
{
    static const float camera[5][3] = {{0, 0, 0}, {2, 0, 0}, {0, 0, 0}, {0, 6, 0}, {2, 0, 0}};
    static const float at[3][4] = {{1, 3, 0, 0}, {0.25f, 1, 0, 6.01f}, {0, 0, 0.1f, 0}}; /* one row per axis */
    static const float larger[4] = {16, 0.5f, 100, 400};
    static const float one[4] = {1, 1, 1, 1};
    const float *const mean[3] = {at[0], at[1], at[2]};
    adcgs_primitives primitives = {.n = 4, .scale = {one, one, one}, .opacity = one};
    float g[3][4] = {{0}};
    adcgs_viewpoints viewpoints = {.n = 0};
    adcgs_error error;
    memcpy(primitives.mean, mean, sizeof mean);
    assert_int_equal(adcgs_viewpoints_create(&viewpoints, camera, 5, &error), ADCGS_OK);
    assert_int_equal(viewpoints.n, 3 + 2 * 3);
    adcgs_scale_penalty(&primitives, &viewpoints, 3, (float *const[]){g[0], g[1], g[2]});
    for (int i = 0; i < 4; i++)
        assert_float_equal(g[0][i], 0.5f * larger[i], 1e-4);
    adcgs_viewpoints_clear(&viewpoints);
}

/** Many primitives before many viewpoints: each uses its nearest viewpoint, at any place in memory. */
static void test_area_many(void **state)
{
    (void)state;
    enum { MANY = 150, SEEN_FROM = 9 };
    static float mean[3][MANY], one[MANY], g[3][MANY], at[SEEN_FROM][3];
    adcgs_primitives primitives = {.n = MANY, .scale = {one, one, one}, .opacity = one};
    memset(g, 0, sizeof g);
    for (int a = 0; a < 3; a++)
        primitives.mean[a] = mean[a];
    for (int i = 0; i < 3 * MANY; i++)
        mean[i / MANY][i % MANY] = (float)adcgs_random_unit(7, 0, (uint64_t)i);
    for (int i = 0; i < 3 * SEEN_FROM; i++)
        at[i / 3][i % 3] = 2 * (float)adcgs_random_unit(7, 1, (uint64_t)i);
    for (int i = 0; i < MANY; i++)
        one[i] = 1;
    const adcgs_viewpoints viewpoints = {.n = SEEN_FROM, .x = at};
    adcgs_scale_penalty(&primitives, &viewpoints, 3 * MANY, (float *const[]){g[0], g[1], g[2]});
    for (int i = 0; i < MANY; i++) {
        double least = INFINITY;
        for (int j = 0; j < SEEN_FROM; j++)
            least = fmin(least, pow((double)(mean[0][i] - at[j][0]), 2) + pow((double)(mean[1][i] - at[j][1]), 2) +
                                    pow((double)(mean[2][i] - at[j][2]), 2));
        assert_float_equal(g[0][i], 2 / fmax(least, 0.0025), 1e-4 * (1 + 2 / fmax(least, 0.0025)));
    }
}

/** Forward pass with noise. The reference gets the noise, which no parameter changes. */
static void forward_noisy(const fixture *x, adcgs_pass *pass)
{
    adcgs_pass_forward(pass, x->f, 0.4f, &(adcgs_pass_mode){.quant = ADCGS_QUANT_NOISE, .deform = 1, .seed = 5});
    memset(pass->grad, 0, 16 * (size_t)pass->primitives.n * sizeof(float));
    for (int g = 0; g < ADCGS_P_ANCHOR; g++)
        noise[g] = calloc(x->f->param[g].n, sizeof(float));
    noisy = 1;
    for (int g = 0; g < ADCGS_P_ANCHOR; g++) /* f_v is first, since the factors of the others depend on it */
        for (uint32_t a = 0; a < ANCHORS; a++)
            for (int r = 0; r < adcgs_fmodel_rows(x->f, g); r++) {
                const size_t at = (size_t)(adcgs_fmodel_at(x->f, g, a, r) - x->f->param[g].p);
                const double moved = (double)pass->used[g][at] - x->f->param[g].p[at];
                noise[g][at] = (float)(moved / step_of(x->f, g, a, r));
                assert_true(fabs((double)noise[g][at]) <= 0.501);
            }
}

static void forget_noise(void)
{
    noisy = 0;
    for (int g = 0; g < ADCGS_P_ANCHOR; g++)
        free(noise[g]);
}

/* The rate alone gives gradients to E_q, f_v and the features through adaptive steps. */
static void test_adaptive_rate_gradients(void **state)
{
    const fixture *x = *state;
    const adcgs_mlp *m = &x->f->mlp[ADCGS_P_E_STEPS];
    adcgs_rate rate;
    clear_gradients(x->f);
    forward_noisy(x, x->pass);
    adcgs_pass_backward(x->pass, x->f, 1, 1, 1, 0, &rate);
    assert_float_equal(rate.total, ref_rate(x->f), 2e-5 * rate.total);
    for (size_t i = m->b[m->hidden]; i < m->n; i++)
        assert_true(x->f->param[ADCGS_P_E_STEPS].g[i] != 0);
    check_gradients(x->f, ref_rate, 0);
    forget_noise();
}

static double total_loss(const adcgs_fmodel *f)
{
    return distortion(f) + ref_rate(f);
}

/* The same for the distortion: the noise scales with the step. */
static void test_adaptive_gradients(void **state)
{
    const fixture *x = *state;
    const size_t slots = x->pass->primitives.n;
    clear_gradients(x->f);
    forward_noisy(x, x->pass);
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++) {
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            for (int v = 0; v < VALUES; v++)
                x->pass->grad[(size_t)v * slots + slot] = (float)weight_of(slot, v);
        }
    adcgs_pass_backward(x->pass, x->f, 1, 1, 1, 0, NULL);
    check_gradients(x->f, total_loss, 0);
    forget_noise();
}

/* Factors stay within two octaves. Beyond the limit a gradient leads back only, not further out. */
static void test_adaptive_limits(void **state)
{
    const fixture *x = *state;
    const adcgs_mlp *m = &x->f->mlp[ADCGS_P_E_STEPS];
    float *b = x->f->param[ADCGS_P_E_STEPS].p + m->b[m->hidden];
    for (int up = 0; up < 2; up++) {
        for (int i = 0; i < m->out; i++)
            b[i] = up ? 9.0f : -9.0f;
        adcgs_mlp_prepare(&x->f->mlp[ADCGS_P_E_STEPS], x->f->param[ADCGS_P_E_STEPS].p, 0);
        clear_gradients(x->f);
        forward_noisy(x, x->pass);
        adcgs_pass_backward(x->pass, x->f, 1, 1, 1, 0, NULL);
        for (int i = 0; i < m->out; i++) {
            const float g = x->f->param[ADCGS_P_E_STEPS].g[m->b[m->hidden] + (size_t)i];
            assert_true(up ? g >= 0 : g < 0); /* the rate favours large steps */
        }
        forget_noise();
    }
}

/* Rounding uses the given factors. */
static void test_adaptive_rounding(void **state)
{
    const fixture *x = *state;
    for (uint32_t i = 0; i < x->f->groups * (2 + CHUNKS) * 64; i++)
        x->pass->factor[i] = (float)pow(2, (double)((int)(i * 7 % 33) - 16) / 8);
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){.quant = ADCGS_QUANT_ROUND});
    for (int g = 0; g < ADCGS_P_ETA; g++)
        for (uint32_t a = 0; a < ANCHORS; a++)
            for (int r = 0; r < adcgs_fmodel_rows(x->f, g); r++) {
                const size_t at = (size_t)(adcgs_fmodel_at(x->f, g, a, r) - x->f->param[g].p);
                const int of = g == ADCGS_P_SIGMA ? 0 : g == ADCGS_P_COLOUR ? 1 : 2 + r % NG / (NG / CHUNKS);
                const double f = g == ADCGS_P_FV ? 1 : x->pass->factor[(a / 64 * (2 + CHUNKS) + (uint32_t)of) * 64 + a % 64];
                const double step = f * x->f->step[g][r], n = (double)x->pass->used[g][at] / step;
                assert_float_equal(n, rint(n), 1e-4);
                assert_true(fabs((double)x->pass->used[g][at] - x->f->param[g].p[at]) <= 0.5001 * step);
            }
}

/* E_q starts at zero, so that switching it on changes no bit. */
static void test_adaptive_start(void **state)
{
    const fixture *x = *state;
    adcgs_param *eq = &x->f->param[ADCGS_P_E_STEPS];
    const adcgs_mlp *m = &x->f->mlp[ADCGS_P_E_STEPS];
    adcgs_fmodel *fresh;
    adcgs_error error;
    assert_int_equal(adcgs_fmodel_create(&fresh, &x->f->params, &x->f->shape, x->f->origin, x->f->voxel,
                                         (const uint32_t(*)[3])x->f->pos, ANCHORS, 3, &error),
                     ADCGS_OK);
    memcpy(eq->p, fresh->param[ADCGS_P_E_STEPS].p, eq->n * sizeof *eq->p);
    adcgs_fmodel_free(&fresh);
    for (size_t i = m->w[m->hidden]; i < m->n; i++)
        assert_true(eq->p[i] == 0);
    adcgs_mlp_prepare(&x->f->mlp[ADCGS_P_E_STEPS], eq->p, 0);
    const size_t bytes = ADCGS_ROWS * (size_t)x->pass->primitives.n * sizeof(float);
    float *with = malloc(bytes);
    const adcgs_pass_mode mode = {.quant = ADCGS_QUANT_NOISE, .deform = 1, .seed = 3};
    adcgs_pass_forward(x->pass, x->f, 0.2f, &mode);
    memcpy(with, x->pass->prim, bytes);
    x->f->params.adaptive_steps = 0;
    adcgs_pass_forward(x->pass, x->f, 0.2f, &mode);
    assert_memory_equal(with, x->pass->prim, bytes);
    x->f->params.adaptive_steps = 1;
    free(with);
}

/** The presence of a single anchor equals the presence in the pass. */
static void test_presence(void **state)
{
    const fixture *x = *state;
    for (uint32_t a = 0; a < ANCHORS; a++) {
        const double u = ref_span(x->f, a, 0.4f);
        assert_float_equal(adcgs_fmodel_presence(x->f, a, 0.4f), exp(-u * u * u * u), 1e-5);
    }
    x->f->params.spans = 0;
    assert_true(adcgs_fmodel_presence(x->f, 0, 0.9f) == 1);
    x->f->params.spans = 1;
}

/** The same gradients, to the bit, with one thread and with seven. */
static void test_threads(void **state)
{
    const fixture *x = *state;
    adcgs_pool *pool;
    adcgs_error error;
    float *first[ADCGS_P_COUNT];
    assert_int_equal(adcgs_pool_create(&pool, 7, &error), ADCGS_OK);
    for (int round = 0; round < 2; round++) {
        adcgs_rate rate;
        adcgs_pass *pass;
        assert_int_equal(adcgs_pass_create(&pass, x->f, x->pass->cpu, round ? pool : NULL, &error), ADCGS_OK);
        clear_gradients(x->f);
        const adcgs_pass_mode mode = {.quant = ADCGS_QUANT_NOISE, .deform = ADCGS_DEFORM_ALL, .dropout = 0.2f, .seed = 99};
        adcgs_pass_forward(pass, x->f, 0.7f, &mode);
        randomise(pass->grad, 16 * (size_t)pass->primitives.n, 0, 0);
        memcpy(pass->grad, pass->prim, ADCGS_ROWS * (size_t)pass->primitives.n * sizeof(float));
        adcgs_pass_backward(pass, x->f, ADCGS_DEFORM_ALL, 0.5f, 1, 0, &rate);
        for (int g = 0; g < ADCGS_P_COUNT; g++) {
            const size_t bytes = x->f->param[g].n * sizeof(float);
            if (!round) {
                first[g] = malloc(bytes + 1);
                memcpy(first[g], x->f->param[g].g, bytes);
                continue;
            }
            assert_memory_equal(first[g], x->f->param[g].g, bytes);
            free(first[g]);
        }
        adcgs_pass_free(&pass);
    }
    adcgs_pool_free(&pool);
}

int main(void)
{
    int failed = 0;
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++) {
        void *const state = (void *)(uintptr_t)level;
        const struct CMUnitTest tests[] = {
            {"forward", test_forward, setup, teardown, state},
            {"distortion gradients", test_distortion_gradients, setup, teardown, state},
            {"other time", test_other_time, setup, teardown, state},
            {"still group", test_still_group, setup, teardown, state},
            {"rate gradients", test_rate_gradients, setup, teardown, state},
            {"step gradients", test_step_gradients, setup, teardown, state},
            {"adaptive rate gradients", test_adaptive_rate_gradients, setup, teardown, state},
            {"adaptive gradients", test_adaptive_gradients, setup, teardown, state},
            {"adaptive limits", test_adaptive_limits, setup, teardown, state},
            {"adaptive rounding", test_adaptive_rounding, setup, teardown, state},
            {"adaptive start", test_adaptive_start, setup, teardown, state},
            {"neighbours", test_neighbours, setup, teardown, state},
            {"rigid", test_rigid, setup, teardown, state},
            {"area", test_area, NULL, NULL, state},
            {"area with viewpoints", test_area_seen, NULL, NULL, state},
            {"area of many", test_area_many, NULL, NULL, state},
            {"threads", test_threads, setup, teardown, state},
        };
        void *const lives = (void *)(uintptr_t)(level + WITH_SPANS);
        const struct CMUnitTest spans[] = {
            {"forward with spans", test_forward, setup, teardown, lives},
            {"distortion gradients with spans", test_distortion_gradients, setup, teardown, lives},
            {"rate gradients with spans", test_rate_gradients, setup, teardown, lives},
            {"step gradients with spans", test_step_gradients, setup, teardown, lives},
            {"adaptive rate gradients with spans", test_adaptive_rate_gradients, setup, teardown, lives},
            {"adaptive gradients with spans", test_adaptive_gradients, setup, teardown, lives},
            {"rounding with spans", test_adaptive_rounding, setup, teardown, lives},
            {"rigid with spans", test_rigid, setup, teardown, lives},
            {"presence", test_presence, setup, teardown, lives},
            {"threads with spans", test_threads, setup, teardown, lives},
        };
        failed += cmocka_run_group_tests_name("train", tests, NULL, NULL);
        failed += cmocka_run_group_tests_name("train with spans", spans, NULL, NULL);
    }
    return failed;
}
