/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Layers in bf16 and their weight gradients against plain sums in double of factors rounded to bf16. Sizes fill no vector, or are
 * large. Nothing is written outside the outputs. Skipped where the CPU has no AVX512-BF16.
 */
#include "base/cpu_detect.h"
#include "grad/dsp.h"
#include "unit/pixels_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { L = 64, MOST = 300, LDW = 310, TILES = 3, GUARD = 64 };

static _Alignas(64) float x[TILES * MOST * L], dy[TILES * MOST * L], out[MOST * LDW + 2 * GUARD], start[MOST * LDW];
static float w[MOST * LDW], bias[MOST], biases_out[MOST];

static void fill(float *v, size_t n, uint64_t *state)
{
    for (size_t i = 0; i < n; i++)
        v[i] = (float)scene_normal(state);
}

/** The nearest number of 8 bits, the even one of two. */
static double rounded(float v)
{
    int e;
    const double m = frexp((double)v, &e);
    return ldexp(nearbyint(ldexp(m, 8)), e - 8);
}

/**
 * A product of two numbers of 8 bits is exact, so only the sums are rounded: at most one half of 2^-23 of the sum of magnitudes
 * for each term.
 */
static void check(float got, double want, double magnitudes, int terms)
{
    if (!(fabs((double)got - want) <= magnitudes * (terms + 2) * 0x1p-24))
        fail_msg("%.9g, expected %.9g within %.3g", (double)got, want, magnitudes * (terms + 2) * 0x1p-24);
}

static void check_guards(size_t n)
{
    for (int i = 0; i < GUARD; i++) {
        assert_true(out[i] == 77.0f);
        assert_true(out[GUARD + n + (size_t)i] == 77.0f);
    }
}

static float *guarded(void)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(out); i++)
        out[i] = 77.0f;
    return out + GUARD;
}

static void check_dense(const adcgs_train_dsp *dsp, int n_out, int n_in, const float *init, const float *b)
{
    float *const y = guarded();
    for (int i = 0; init == y && i < n_out * L; i++)
        y[i] = start[i];
    dsp->dense.dense(y, init, b, w, LDW, x, n_out, n_in);
    for (int o = 0; o < n_out; o++)
        for (int l = 0; l < L; l++) {
            double sum = init ? (double)start[o * L + l] : b ? (double)b[o] : 0, magnitudes = fabs(sum);
            for (int i = 0; i < n_in; i++) {
                const double term = rounded(w[o * LDW + i]) * rounded(x[i * L + l]);
                sum += term;
                magnitudes += fabs(term);
            }
            check(y[o * L + l], sum, magnitudes, n_in);
        }
    check_guards((size_t)n_out * L);
}

/** A sum of a layer of n units from packed weights, and the sum of magnitudes. */
static double square_sum(int n, int o, int l, double first, const float *v, double *magnitudes)
{
    double sum = first;
    *magnitudes = fabs(first);
    for (int i = 0; i < n; i++) {
        const double term = rounded(w[o * n + i]) * rounded(v[i * L + l]);
        sum += term;
        *magnitudes += fabs(term);
    }
    return sum;
}

/** A residual layer and its backward pass, with w instead of its transpose. */
static void check_residual(const adcgs_train_dsp *dsp, int n)
{
    static _Alignas(64) uint32_t packed[MOST * LDW];
    static _Alignas(64) float dz[MOST * L];
    uint64_t below[MOST];
    const adcgs_square square = {n, w, packed};
    float *const h = guarded();
    double magnitudes;
    assert_true(adcgs_square_words(n) <= ADCGS_COUNTOF(packed));
    dsp->pack(packed, w, n);
    dsp->residual(dsp, h, below, bias, &square, x);
    for (int o = 0; o < n; o++)
        for (int l = 0; l < L; l++) {
            const double z = square_sum(n, o, l, (double)bias[o], x, &magnitudes), in = (double)x[o * L + l];
            check(h[o * L + l], in + (z < 0 ? z / 64 : z), magnitudes + fabs(in), n);
            if (fabs(z) > magnitudes * n * 0x1p-24)
                assert_int_equal(below[o] >> l & 1, z < 0);
        }
    check_guards((size_t)n * L);
    float *const dx = guarded();
    memcpy(dx, dy, (size_t)(n * L) * sizeof *dx);
    dsp->residual_back(dsp, dx, dz, below, &square, dx, NULL);
    for (int o = 0; o < n; o++)
        for (int l = 0; l < L; l++) {
            assert_true(dz[o * L + l] == dy[o * L + l] * (below[o] >> l & 1 ? 0x1p-6f : 1.0f));
            const double d = square_sum(n, o, l, (double)dy[o * L + l], dz, &magnitudes);
            check(dx[o * L + l], d, magnitudes, n);
        }
    check_guards((size_t)n * L);
}

static void check_gradient(const adcgs_train_dsp *dsp, int n_out, int n_in, int tiles, int with_biases)
{
    float *const gw = guarded();
    memcpy(gw, start, (size_t)n_out * LDW * sizeof *gw);
    memcpy(biases_out, bias, sizeof bias);
    dsp->weight_grad(gw, LDW, with_biases ? biases_out : NULL, dy, MOST * L, x, MOST * L, tiles, n_out, n_in);
    for (int o = 0; o < n_out; o++)
        for (int i = 0; i < LDW; i++) {
            double sum = (double)start[o * LDW + i], magnitudes = fabs(sum);
            for (int k = 0; i < n_in && k < tiles * L; k++) {
                const size_t tile = (size_t)(k / L) * MOST * L, lane = (size_t)(k % L);
                const double term = rounded(dy[tile + (size_t)(o * L) + lane]) * rounded(x[tile + (size_t)(i * L) + lane]);
                sum += term;
                magnitudes += fabs(term);
            }
            check(gw[o * LDW + i], sum, magnitudes, tiles * L);
        }
    check_guards((size_t)n_out * LDW);
    for (int o = 0; o < MOST; o++) { /* biases are not rounded */
        double sum = (double)bias[o], magnitudes = fabs(sum);
        for (int k = 0; with_biases && o < n_out && k < tiles * L; k++) {
            const double term = (double)dy[(k / L * MOST + o) * L + k % L];
            sum += term;
            magnitudes += fabs(term);
        }
        check(biases_out[o], sum, magnitudes, tiles * L);
    }
}

static void take_kernels(adcgs_train_dsp *dsp)
{
    uint64_t random = 4;
    adcgs_error error;
    const adcgs_cpu_level level = adcgs_cpu_best();
    if (adcgs_bf16_check(level, &error) != ADCGS_OK) {
        print_message("%s\n", error.text);
        skip();
    }
    adcgs_train_dsp_init_bf16(dsp, level);
    fill(x, ADCGS_COUNTOF(x), &random);
    fill(dy, ADCGS_COUNTOF(dy), &random);
    fill(start, ADCGS_COUNTOF(start), &random);
    fill(w, ADCGS_COUNTOF(w), &random);
    fill(bias, ADCGS_COUNTOF(bias), &random);
    x[3] = -0.0f;
    x[L + 7] = 1 + 0x1p-8f; /* half-way between two */
    w[1] = 1 + 3 * 0x1p-8f;
}

static void test_layers(void **state)
{
    static const int outputs[] = {1, 5, 6, 7, 13, 32, 100, 256};
    static const int inputs[] = {0, 1, 2, 31, 32, 33, 127, 128, 129, 300};
    adcgs_train_dsp dsp;
    take_kernels(&dsp);
    for (size_t o = 0; o < ADCGS_COUNTOF(outputs); o++)
        for (size_t i = 0; i < ADCGS_COUNTOF(inputs); i++) {
            check_dense(&dsp, outputs[o], inputs[i], NULL, NULL);
            check_dense(&dsp, outputs[o], inputs[i], NULL, bias);
            check_dense(&dsp, outputs[o], inputs[i], start, NULL);
            check_dense(&dsp, outputs[o], inputs[i], out + GUARD, NULL);
        }
}

static void test_gradients(void **state)
{
    static const int outputs[] = {1, 5, 6, 7, 14, 32, 100, 257}, inputs[] = {1, 8, 15, 16, 17, 33, 48, 64, 65, 300};
    adcgs_train_dsp dsp;
    take_kernels(&dsp);
    for (size_t o = 0; o < ADCGS_COUNTOF(outputs); o++)
        for (size_t i = 0; i < ADCGS_COUNTOF(inputs); i++)
            check_gradient(&dsp, outputs[o], inputs[i], 1 + (int)((o + i) % TILES), (int)(i & 1));
}

static void test_residual_layers(void **state)
{
    static const int units[] = {1, 2, 7, 31, 32, 33, 100, 128, 129, 256, 300};
    adcgs_train_dsp dsp;
    take_kernels(&dsp);
    for (size_t i = 0; i < ADCGS_COUNTOF(units); i++)
        check_residual(&dsp, units[i]);
}

/** Without the kernels, or at another level, the error is one line, and the kernels are those of binary32. */
static void test_check(void **state)
{
    for (adcgs_cpu_level level = ADCGS_CPU_SCALAR; level < ADCGS_CPU_AVX512; level++) {
        adcgs_error error;
        assert_int_equal(adcgs_bf16_check(level, &error), ADCGS_ERR_UNSUPPORTED);
        assert_non_null(strstr(error.text, "bf16"));
        if (level <= adcgs_cpu_best()) {
            adcgs_train_dsp plain, dsp;
            adcgs_train_dsp_init(&plain, level);
            adcgs_train_dsp_init_bf16(&dsp, level);
            assert_true(dsp.weight_grad == plain.weight_grad && dsp.dense.dense == plain.dense.dense && !dsp.pack);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_layers), cmocka_unit_test(test_gradients),
                                       cmocka_unit_test(test_residual_layers), cmocka_unit_test(test_check)};
    return cmocka_run_group_tests_name("bf16", tests, NULL, NULL);
}
