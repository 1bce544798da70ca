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

#include "train_fixture.h"

#include "fmodel/pass.h"

#include <math.h>
#include <stdlib.h>

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
            {"threads", test_threads, setup, teardown, state},
        };
        void *const lives = (void *)(uintptr_t)(level + WITH_SPANS);
        const struct CMUnitTest spans[] = {
            {"forward with spans", test_forward, setup, teardown, lives},
            {"distortion gradients with spans", test_distortion_gradients, setup, teardown, lives},
            {"rate gradients with spans", test_rate_gradients, setup, teardown, lives},
            {"step gradients with spans", test_step_gradients, setup, teardown, lives},
            {"presence", test_presence, setup, teardown, lives},
            {"threads with spans", test_threads, setup, teardown, lives},
        };
        failed += cmocka_run_group_tests_name("train", tests, NULL, NULL);
        failed += cmocka_run_group_tests_name("train with spans", spans, NULL, NULL);
    }
    return failed;
}
