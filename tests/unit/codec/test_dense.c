/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Dense layers: every CPU level gives the bits of the sequential sum. */
#include "base/cpu_detect.h"
#include "splat/dense.h"
#include "unit/pixels_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

#define MOST 70
#define LDW 75

static _Alignas(64) float x[MOST * 64], init[MOST * 64], y[MOST * 64], expected[MOST * 64];
static float w[MOST * LDW], bias[MOST];

static void fill(float *v, size_t n, uint64_t *state)
{
    for (size_t i = 0; i < n; i++)
        v[i] = (float)(scene_normal(state) * exp(4.0 * scene_normal(state)));
}

static void reference(int n_out, int n_in, const float *start, const float *b)
{
    for (int o = 0; o < n_out; o++)
        for (int l = 0; l < 64; l++) {
            float sum = start ? start[o * 64 + l] : b ? b[o] : 0.0f;
            for (int i = 0; i < n_in; i++)
                sum = fmaf(w[o * LDW + i], x[i * 64 + l], sum);
            expected[o * 64 + l] = sum;
        }
}

static void check_shape(const adcgs_dense_dsp *dsp, int n_out, int n_in)
{
    const size_t bytes = (size_t)n_out * 64 * sizeof(float);
    reference(n_out, n_in, init, bias);
    dsp->dense(y, init, bias, w, LDW, x, n_out, n_in);
    assert_memory_equal(y, expected, bytes);
    memcpy(y, init, bytes);
    dsp->dense(y, y, NULL, w, LDW, x, n_out, n_in);
    assert_memory_equal(y, expected, bytes);
    reference(n_out, n_in, NULL, bias);
    dsp->dense(y, NULL, bias, w, LDW, x, n_out, n_in);
    assert_memory_equal(y, expected, bytes);
    reference(n_out, n_in, NULL, NULL);
    dsp->dense(y, NULL, NULL, w, LDW, x, n_out, n_in);
    assert_memory_equal(y, expected, bytes);
    for (int i = 0; i < n_out * 64; i++)
        expected[i] = expected[i] < 0.0f ? expected[i] * 0x1p-6f : expected[i];
    dsp->lrelu(y, n_out);
    assert_memory_equal(y, expected, bytes);
    for (int i = 0; i < n_out * 64; i++)
        expected[i] = x[i] + (expected[i] < 0.0f ? expected[i] * 0x1p-6f : expected[i]);
    dsp->residual(y, x, n_out);
    assert_memory_equal(y, expected, bytes);
}

/* REQ-CONV-002, REQ-PRIM-008, REQ-PRIM-020 */
static void test_dense(void **state)
{
    static const int sizes[] = {0, 1, 2, 3, 5, 6, 7, 9, 11, 12, 13, 14, 16, 23, 32, 48, 64, 70};
    uint64_t random = 4;
    fill(x, ADCGS_COUNTOF(x), &random);
    fill(init, ADCGS_COUNTOF(init), &random);
    fill(w, ADCGS_COUNTOF(w), &random);
    fill(bias, ADCGS_COUNTOF(bias), &random);
    x[3] = -0.0f;
    x[64 + 7] = 0x1p-140f;
    for (adcgs_cpu_level cpu = ADCGS_CPU_SCALAR; cpu <= adcgs_cpu_best(); cpu++) {
        adcgs_dense_dsp dsp;
        adcgs_dense_dsp_init(&dsp, cpu);
        for (size_t o = 0; o < ADCGS_COUNTOF(sizes); o++)
            for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++)
                check_shape(&dsp, sizes[o], sizes[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_dense)};
    return cmocka_run_group_tests_name("dense", tests, NULL, NULL);
}
