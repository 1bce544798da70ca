/* SPDX-License-Identifier: BSD-2-Clause */
/** \file PSNR and SSIM against slow direct references. */
#include "metric/metric.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static uint32_t seed = 1;

static float random_value(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) / 16777216.0f;
}

/** A pixel of a channel, 0 beyond the edges. */
static double at(const float *plane, int width, int height, int x, int y)
{
    return x < 0 || y < 0 || x >= width || y >= height ? 0.0 : (double)plane[y * width + x];
}

/** The definition, written out: a two-dimensional window of 11x11 around every pixel. */
static double reference_ssim(const float *a, const float *b, int width, int height)
{
    double weight[11][11], sum = 0.0, total = 0.0;
    for (int i = 0; i < 11; i++)
        for (int j = 0; j < 11; j++)
            sum += weight[i][j] = exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
                for (int i = 0; i < 11; i++)
                    for (int j = 0; j < 11; j++) {
                        const double w = weight[i][j] / sum;
                        const double va = at(a + c * width * height, width, height, x + j - 5, y + i - 5);
                        const double vb = at(b + c * width * height, width, height, x + j - 5, y + i - 5);
                        ma += w * va;
                        mb += w * vb;
                        aa += w * va * va;
                        bb += w * vb * vb;
                        ab += w * va * vb;
                    }
                total += (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) /
                         ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
            }
    return total / (3.0 * width * height);
}

static void check_ssim(int width, int height)
{
    const int n = 3 * width * height;
    float *a = malloc((size_t)n * sizeof *a), *b = malloc((size_t)n * sizeof *b);
    double got;
    for (int i = 0; i < n; i++) {
        a[i] = random_value();
        b[i] = 0.7f * a[i] + 0.3f * random_value();
    }
    assert_int_equal(adcgs_ssim(a, b, width, height, &got, NULL), ADCGS_OK);
    assert_true(fabs(got - reference_ssim(a, b, width, height)) < 1e-12);
    assert_int_equal(adcgs_ssim(a, a, width, height, &got, NULL), ADCGS_OK);
    assert_true(fabs(got - 1.0) < 1e-9);
    free(a);
    free(b);
}

static void test_ssim(void **state)
{
    static const int sizes[][2] = {{1, 1}, {1, 7}, {5, 2}, {11, 11}, {13, 40}, {64, 9}};
    for (size_t i = 0; i < ADCGS_COUNTOF(sizes); i++)
        check_ssim(sizes[i][0], sizes[i][1]);
    double got;
    assert_int_equal(adcgs_ssim(NULL, NULL, 0, 5, &got, NULL), ADCGS_ERR_USAGE);
}

static void test_psnr(void **state)
{
    static float a[3000], b[3000];
    double sum = 0.0;
    for (int i = 0; i < 3000; i++) {
        a[i] = random_value();
        b[i] = random_value();
        sum += pow((double)a[i] - (double)b[i], 2);
    }
    assert_true(fabs(adcgs_psnr(a, b, 3000) - 10 * log10(3000 / sum)) < 1e-10);
    assert_true(adcgs_psnr(a, a, 3000) == 99.0);
    assert_true(adcgs_psnr_from_mse(1e-30) == 99.0);
    assert_true(fabs(adcgs_psnr_from_mse(0.01) - 20.0) < 1e-12);
    assert_true(isnan(adcgs_psnr_from_mse(NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ssim), cmocka_unit_test(test_psnr)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
