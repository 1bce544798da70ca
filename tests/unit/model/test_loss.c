/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The training loss against a direct evaluation in double with a two-dimensional window. Its gradient against central differences
 * of that evaluation. Both have the same bits at every CPU level and thread count.
 */
#include "grad/loss.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#define WEIGHT 0.2
#define SQUARE 0.6

/* The error of a value, without SSIM. */
static double error_of(double e)
{
    return (1 - SQUARE) * fabs(e) + SQUARE * e * e / 0.2;
}

static double window(int dx, int dy)
{
    static double norm;
    if (norm == 0.0)
        for (int k = -5; k <= 5; k++)
            norm += exp(-k * k / 4.5);
    return abs(dx) > 5 || abs(dy) > 5 ? 0.0 : exp(-(dx * dx + dy * dy) / 4.5) / (norm * norm);
}

/* SSIM of one channel at one pixel, zero padding. */
static double ssim_at(const double *x, const double *y, int w, int h, int px, int py)
{
    double m = 0.0, n = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    for (int v = ADCGS_MAX(0, py - 5); v <= ADCGS_MIN(h - 1, py + 5); v++)
        for (int u = ADCGS_MAX(0, px - 5); u <= ADCGS_MIN(w - 1, px + 5); u++) {
            const double g = window(u - px, v - py), a = x[v * w + u], b = y[v * w + u];
            m += g * a;
            n += g * b;
            xx += g * a * a;
            yy += g * b * b;
            xy += g * a * b;
        }
    return (2 * m * n + 1e-4) * (2 * (xy - m * n) + 9e-4) / ((m * m + n * n + 1e-4) * (xx - m * m + yy - n * n + 9e-4));
}

static adcgs_loss_value reference(const double *x, const double *y, int w, int h)
{
    adcgs_loss_value v = {0.0, 0.0, 0.0, 0.0};
    const int plane = w * h;
    for (int i = 0; i < 3 * plane; i++) {
        v.l1 += fabs(x[i] - y[i]) / (3 * plane);
        v.mse += (x[i] - y[i]) * (x[i] - y[i]) / (3 * plane);
        v.ssim += ssim_at(x + i / plane * plane, y + i / plane * plane, w, h, i % plane % w, i % plane / w) / (3 * plane);
    }
    v.loss = (1 - WEIGHT) * ((1 - SQUARE) * v.l1 + SQUARE * v.mse / 0.2) + WEIGHT * (1 - v.ssim);
    return v;
}

/* Change of the loss when value i moves by +-e: only pixels within the window can change. */
static double slope(double *x, const double *y, int w, int h, int i)
{
    const double e = 1e-5, keep = x[i];
    const int plane = w * h, at = i % plane;
    double side[2];
    for (int s = 0; s < 2; s++) {
        x[i] = keep + (s ? e : -e);
        side[s] = (1 - WEIGHT) * error_of(x[i] - y[i]);
        for (int v = ADCGS_MAX(0, at / w - 5); v <= ADCGS_MIN(h - 1, at / w + 5); v++)
            for (int u = ADCGS_MAX(0, at % w - 5); u <= ADCGS_MIN(w - 1, at % w + 5); u++)
                side[s] -= WEIGHT * ssim_at(x + i / plane * plane, y + i / plane * plane, w, h, u, v);
    }
    x[i] = keep;
    return (side[1] - side[0]) / (2 * e) / (3 * plane);
}

typedef struct pictures {
    int w, h;
    float *x, *y, *grad;
    double *dx, *dy;
} pictures;

/* Two related images; x differs from y everywhere by more than the step of the differences. */
static pictures make(int w, int h)
{
    const size_t n = 3 * (size_t)w * (size_t)h;
    pictures p =
        {.w = w, .h = h, .x = malloc(n * 4), .y = malloc(n * 4), .grad = malloc(n * 4), .dx = malloc(n * 8), .dy = malloc(n * 8)};
    uint32_t seed = 12345u + (uint32_t)w;
    for (size_t i = 0; i < n; i++) {
        seed = seed * 1664525u + 1013904223u;
        const double noise = (seed >> 8) / 16777216.0,
                     wave = 0.5 + 0.3 * sin((double)(i % (size_t)w) * 0.3) * cos((double)i * 0.01);
        p.y[i] = (float)(0.8 * wave + 0.2 * noise);
        seed = seed * 1664525u + 1013904223u;
        const float change = 0.01f + 0.15f * (float)(seed >> 9) / 8388608.0f;
        p.x[i] = p.y[i] + (seed & 256 ? change : -change);
        p.dx[i] = p.x[i];
        p.dy[i] = p.y[i];
    }
    return p;
}

static void drop(pictures *p)
{
    free(p->x);
    free(p->y);
    free(p->grad);
    free(p->dx);
    free(p->dy);
}

static adcgs_loss_value run(adcgs_cpu_level cpu, int threads, pictures *p, float weight)
{
    adcgs_pool *pool = NULL;
    adcgs_loss *loss = NULL;
    adcgs_loss_value value;
    assert_int_equal(adcgs_pool_create(&pool, threads, NULL), ADCGS_OK);
    assert_int_equal(adcgs_loss_create(&loss, cpu, pool, NULL), ADCGS_OK);
    const adcgs_loss_shares shares = {weight, (float)SQUARE};
    for (int twice = 0; twice < 2; twice++) /* the second run uses a used workspace */
        assert_int_equal(adcgs_loss_image(loss, p->x, p->y, p->w, p->h, &shares, p->grad, &value, NULL), ADCGS_OK);
    adcgs_loss_free(&loss);
    assert_null(loss);
    adcgs_pool_free(&pool);
    return value;
}

static void check_reference(int w, int h, int step)
{
    pictures p = make(w, h);
    const adcgs_loss_value got = run(ADCGS_CPU_AUTO, 1, &p, (float)WEIGHT), want = reference(p.dx, p.dy, w, h);
    assert_true(fabs(got.l1 - want.l1) < 1e-6);
    assert_true(fabs(got.mse - want.mse) < 1e-6);
    assert_true(fabs(got.ssim - want.ssim) < 2e-5);
    assert_true(fabs(got.loss - want.loss) < 1e-5);
    for (int i = 0; i < 3 * w * h; i += step) {
        const double d = slope(p.dx, p.dy, w, h, i), scale = 1.0 / (3 * w * h);
        assert_true(fabs(p.grad[i] - d) < 1e-3 * scale);
    }
    drop(&p);
}

static void agrees_with_reference(void **state)
{
    (void)state;
    check_reference(1, 1, 1);
    check_reference(3, 29, 1);
    check_reference(37, 23, 1);
    check_reference(300, 14, 7);
    check_reference(430, 7, 5);
}

static void levels_and_threads_do_not_matter(void **state)
{
    (void)state;
    for (int size = 0; size < 3; size++) {
        pictures p = make(size == 0 ? 16 : size == 1 ? 257 : 401, size == 0 ? 5 : 40);
        const size_t bytes = 3 * sizeof(float) * (size_t)p.w * (size_t)p.h;
        const adcgs_loss_value want = run(ADCGS_CPU_SCALAR, 1, &p, 0.2f);
        float *const grad = malloc(bytes);
        memcpy(grad, p.grad, bytes);
        for (int level = ADCGS_CPU_SCALAR; level <= (int)adcgs_cpu_best(); level++)
            for (int threads = 1; threads < 8; threads += 3) {
                const adcgs_loss_value got = run((adcgs_cpu_level)level, threads, &p, 0.2f);
                assert_memory_equal(&got, &want, sizeof got);
                assert_memory_equal(p.grad, grad, bytes);
            }
        free(grad);
        drop(&p);
    }
}

static void works_without_ssim(void **state)
{
    pictures p = make(50, 70);
    const adcgs_loss_value got = run(ADCGS_CPU_AUTO, 2, &p, 0.0f), want = reference(p.dx, p.dy, p.w, p.h);
    (void)state;
    assert_true(fabs(got.l1 - want.l1) < 1e-7 && fabs(got.mse - want.mse) < 1e-7);
    assert_true(fabs(got.loss - (1 - SQUARE) * want.l1 - SQUARE * want.mse / 0.2) < 1e-7);
    for (int i = 0; i < 3 * p.w * p.h; i++) {
        const double e = p.dx[i] - p.dy[i], pull = (1 - SQUARE) * (e > 0 ? 1 : -1) + SQUARE * e / 0.1;
        assert_true(fabs(p.grad[i] - pull / (3.0 * p.w * p.h)) < 1e-9);
    }
    drop(&p);
}

static void equal_pictures_are_perfect(void **state)
{
    pictures p = make(48, 20);
    (void)state;
    memcpy(p.x, p.y, 3 * sizeof(float) * (size_t)p.w * (size_t)p.h);
    const adcgs_loss_value got = run(ADCGS_CPU_AUTO, 1, &p, 0.2f);
    assert_true(got.l1 == 0.0 && got.mse == 0.0 && fabs(got.ssim - 1.0) < 1e-6);
    for (int i = 0; i < 3 * p.w * p.h; i++)
        assert_true(fabsf(p.grad[i]) < 1e-7f);
    drop(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_reference),
        cmocka_unit_test(levels_and_threads_do_not_matter),
        cmocka_unit_test(works_without_ssim),
        cmocka_unit_test(equal_pictures_are_perfect),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
