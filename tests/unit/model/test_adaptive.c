/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Adaptive steps in training: their gradients against central differences, limits, rounding and start. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "train_fixture.h"

#include "fmodel/pass.h"

#include <math.h>
#include <stdlib.h>

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

int main(void)
{
    int failed = 0;
    for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++) {
        void *const state = (void *)(uintptr_t)level;
        const struct CMUnitTest tests[] = {
            {"adaptive rate gradients", test_adaptive_rate_gradients, setup, teardown, state},
            {"adaptive gradients", test_adaptive_gradients, setup, teardown, state},
            {"adaptive limits", test_adaptive_limits, setup, teardown, state},
            {"adaptive rounding", test_adaptive_rounding, setup, teardown, state},
            {"adaptive start", test_adaptive_start, setup, teardown, state},
        };
        void *const lives = (void *)(uintptr_t)(level + WITH_SPANS);
        const struct CMUnitTest spans[] = {
            {"adaptive rate gradients with spans", test_adaptive_rate_gradients, setup, teardown, lives},
            {"adaptive gradients with spans", test_adaptive_gradients, setup, teardown, lives},
            {"rounding with spans", test_adaptive_rounding, setup, teardown, lives},
        };
        failed += cmocka_run_group_tests_name("adaptive", tests, NULL, NULL);
        failed += cmocka_run_group_tests_name("adaptive with spans", spans, NULL, NULL);
    }
    return failed;
}
