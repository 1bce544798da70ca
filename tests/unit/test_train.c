/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The trainer's passes against an independent reference in binary64: values of
 * primitives and bits, and every gradient against central differences.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "train/pass.h"
#include "train/random.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { K = 3, NV = 5, NG = 4, CHUNKS = 2, ETA = 2, OCTAVES = 2, ANCHORS = 70, VALUES = 14 };

/* ---- Reference ---- */

/** Evaluate a network on one sample in binary64 straight from the parameters. */
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

static double value(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    return *adcgs_fmodel_at(f, group, anchor, row);
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
    const int rows = f->params.time_rows, width = f->params.time_width;
    const double u = t * (rows - 1);
    const int i = (int)fmin(floor(u), rows - 2);
    const float *z = f->param[ADCGS_P_TIME].p;
    for (int j = 0; j < width; j++)
        code[j] = z[i * width + j] + (u - i) * (z[(i + 1) * width + j] - (double)z[i * width + j]);
}

/** Primitive k of an anchor at time t: mean 3, scale 3, rotation 4, opacity, colour 3. */
static void ref_primitive(const adcgs_fmodel *f, uint32_t anchor, int k, double t, double out[VALUES])
{
    double x[64], th[14], om[12], va[4 * K], q0[4], qr[4], q[4], off[4] = { 0 }, turned[4], back[4];
    for (int i = 0; i < NV; i++)
        x[i] = value(f, ADCGS_P_FV, anchor, i);
    for (int i = 0; i < NG; i++)
        x[NV + i] = value(f, ADCGS_P_FG, anchor, k * NG + i);
    ref_mlp(&f->mlp[ADCGS_P_THETA], f->param[ADCGS_P_THETA].p, x, th);
    time_code(f, t, x + NV);
    ref_mlp(&f->mlp[ADCGS_P_OMEGA], f->param[ADCGS_P_OMEGA].p, x, om);
    double y[64];
    for (int i = 0; i < 6 * OCTAVES; i++)
        y[i] = f->code[((size_t)(anchor / 64) * 6 * OCTAVES + (size_t)i) * 64 + anchor % 64];
    memcpy(y + 6 * OCTAVES, x, NV * sizeof *x);
    time_code(f, t, y + 6 * OCTAVES + NV);
    ref_mlp(&f->mlp[ADCGS_P_VARPI], f->param[ADCGS_P_VARPI].p, y, va);
    const double moving = f->moving[anchor];
    for (int i = 0; i < 12; i++)
        om[i] *= moving;
    qr[0] = 1;
    q0[0] = th[6] + 1;
    for (int a = 0; a < 3; a++) {
        qr[1 + a] = om[9 + a];
        q0[1 + a] = th[7 + a];
        off[1 + a] = th[a] * exp(value(f, ADCGS_P_SIGMA, anchor, a));
    }
    normalise(qr);
    normalise(q0);
    product(qr, q0, q);
    const double conj[4] = { qr[0], -qr[1], -qr[2], -qr[3] };
    product(qr, off, turned);
    product(turned, conj, back);
    for (int a = 0; a < 3; a++) {
        out[a] = f->x[((size_t)(anchor / 64) * 3 + (size_t)a) * 64 + anchor % 64] + om[a] + back[1 + a];
        out[3 + a] = exp(value(f, ADCGS_P_SIGMA, anchor, 3 + a)) * sigmoid(th[3 + a]) * exp(om[3 + a]);
        out[11 + a] = value(f, ADCGS_P_COLOUR, anchor, a) + th[10 + a] + om[6 + a] + moving * va[4 * k + 1 + a];
    }
    memcpy(out + 6, q, sizeof q);
    out[10] = 0.99 * sigmoid(th[13] + moving * va[4 * k]) * f->keep[((size_t)(anchor / 64) * K + (size_t)k) * 64 + anchor % 64];
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
        bits += ref_bits(value(f, group, anchor, first + i), f->step[group][first + i], out[i], out[rows + i]);
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
        bits += ref_rows(f, ADCGS_P_E_SIGMA, x, ADCGS_P_SIGMA, a, 0, 6);
        bits += ref_rows(f, ADCGS_P_E_COLOUR, x, ADCGS_P_COLOUR, a, 0, 3);
        for (int k = 0; k < K; k++) {
            if (f->keep[((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64] == 0)
                continue;
            for (int i = 0; i < NG; i++)
                x[NV + i] = value(f, ADCGS_P_FG, a, k * NG + i) / (16.0 * f->step[ADCGS_P_FG][k * NG + i]);
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

static int setup(void **state)
{
    const adcgs_params params = { .k = K, .n_fv = NV, .n_fg = NG, .chunks = CHUNKS, .n_eta = ETA, .octaves = OCTAVES,
                                  .fine_uses_fv = 1, .coarse_rotation = 1, .time_rows = 4, .time_width = 3 };
    const adcgs_shape shape = { .theta_width = 6, .theta_hidden = 2, .omega_width = 5, .omega_hidden = 3, .varpi_width = 6,
                                .varpi_hidden = 2, .entropy_width = 6, .entropy_hidden = 2, .step_fv = 0.1f, .step_fg = 0.2f,
                                .step_sigma = 0.1f, .step_colour = 0.05f, .depth = 8 };
    const float origin[3] = { -1, -1, -1 };
    static uint32_t pos[ANCHORS][3];
    for (uint32_t i = 0; i < ANCHORS; i++)
        pos[i][0] = i, pos[i][1] = 3 * i % 200, pos[i][2] = 7 * i % 200;
    fixture *x = calloc(1, sizeof *x);
    adcgs_error error;
    assert_int_equal(adcgs_fmodel_create(&x->f, &params, &shape, origin, 1.0f / 128, (const uint32_t(*)[3])pos, ANCHORS, 3,
                                         &error), ADCGS_OK);
    for (int i = 0; i < ADCGS_P_COUNT; i++) {
        randomise(x->f->param[i].p, x->f->param[i].n, i < ADCGS_P_ANCHOR ? 0.4 : 0.15, (uint64_t)i);
        if (x->f->mlp[i].n)
            adcgs_mlp_prepare(&x->f->mlp[i], x->f->param[i].p, 0);
    }
    x->f->moving[5] = 0;
    x->f->keep[1 * 64 + 9] = 0;
    assert_int_equal(adcgs_pass_create(&x->pass, x->f, (adcgs_cpu_level)(uintptr_t)*state, NULL, &error), ADCGS_OK);
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

/** A fixed random weight for value v of a slot: the scalar whose gradient is tested is the weighted sum of all primitives. */
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
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){ .deform = 1 });
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++) {
            double p[VALUES];
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            ref_primitive(x->f, a, k, 0.4f, p);
            for (int v = 0; v < VALUES; v++)
                assert_float_equal(x->pass->prim[(size_t)v * slots + slot], p[v], 2e-5 * (1 + fabs(p[v])));
        }
}

typedef double (*scalar_fn)(const adcgs_fmodel *f);

static double distortion(const adcgs_fmodel *f)
{
    return ref_sum(f, 0.4f);
}

/** Compare gradients of a sample of each group's parameters with central differences of fn. */
static void check_gradients(const adcgs_fmodel *f, scalar_fn fn, int first_group)
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
            const float keep = p->p[i], h = 1e-4f;
            p->p[i] = keep + h;
            const double hi = p->p[i], up = fn(f);
            p->p[i] = keep - h;
            const double lo = p->p[i], down = fn(f);
            p->p[i] = keep;
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
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){ .deform = 1 });
    memset(x->pass->grad, 0, 16 * slots * sizeof(float));
    for (uint32_t a = 0; a < ANCHORS; a++)
        for (int k = 0; k < K; k++) {
            const size_t slot = ((size_t)(a / 64) * K + (size_t)k) * 64 + a % 64;
            for (int v = 0; v < VALUES; v++)
                x->pass->grad[(size_t)v * slots + slot] = (float)weight_of(slot, v);
        }
    adcgs_pass_backward(x->pass, x->f, 1, 0, 0, 0, NULL);
    check_gradients(x->f, distortion, 0);
}

static void test_rate_gradients(void **state)
{
    const fixture *x = *state;
    adcgs_rate rate;
    clear_gradients(x->f);
    adcgs_pass_forward(x->pass, x->f, 0.4f, &(adcgs_pass_mode){ .deform = 1 });
    memset(x->pass->grad, 0, 16 * (size_t)x->pass->primitives.n * sizeof(float));
    adcgs_pass_backward(x->pass, x->f, 1, 1, 1, 0, &rate);
    assert_float_equal(rate.total, ref_rate(x->f), 5e-6 * rate.total);
    for (int g = ADCGS_P_E_FV; g < ADCGS_P_E_FG + CHUNKS; g++)
        for (size_t i = x->f->mlp[g].b[x->f->mlp[g].hidden]; i < x->f->param[g].n; i++)
            assert_true(x->f->param[g].g[i] != 0); /* a live gradient into every entropy network */
    check_gradients(x->f, ref_rate, 0);
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
        adcgs_pass_forward(pass, x->f, 0.7f, &(adcgs_pass_mode){ .quant = ADCGS_QUANT_NOISE, .deform = 1, .dropout = 0.2f,
                                                                 .seed = 99 });
        randomise(pass->grad, 16 * (size_t)pass->primitives.n, 0, 0);
        memcpy(pass->grad, pass->prim, 14 * (size_t)pass->primitives.n * sizeof(float));
        adcgs_pass_backward(pass, x->f, 1, 0.5f, 1, 0, &rate);
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
            { "forward", test_forward, setup, teardown, state },
            { "distortion gradients", test_distortion_gradients, setup, teardown, state },
            { "rate gradients", test_rate_gradients, setup, teardown, state },
            { "threads", test_threads, setup, teardown, state },
        };
        failed += cmocka_run_group_tests_name("train", tests, NULL, NULL);
    }
    return failed;
}
