/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * PSNR, SSIM and MS-SSIM against slow direct references; boxes and the parts of images that they cover; the amount of detail.
 */
#include "metric_reference.h"

#include "metric/crop.h"
#include "metric/detail.h"
#include "metric/metric.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

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

static double check_ms_ssim(int width, int height, int expected_scales)
{
    const int n = 3 * width * height;
    float *a = malloc((size_t)n * sizeof *a), *b = malloc((size_t)n * sizeof *b);
    double got, same;
    int scales;
    for (int i = 0; i < n; i++) {
        a[i] = 0.5f * random_value() + (float)(i % width / 9 % 2) * 0.5f;
        b[i] = 0.7f * a[i] + 0.3f * random_value();
    }
    assert_int_equal(adcgs_ms_ssim(a, b, width, height, &got, &scales, NULL), ADCGS_OK);
    assert_int_equal(scales, expected_scales);
    if (scales) {
        const double reference = reference_ms_ssim(a, b, width, height, scales);
        if (!(fabs(got - reference) < 1e-11))
            fail_msg("%dx%d: %.15g, reference %.15g", width, height, got, reference);
        assert_true(got > 0.1 && got < 0.99);
        assert_int_equal(adcgs_ms_ssim(a, a, width, height, &same, &scales, NULL), ADCGS_OK);
        assert_true(fabs(same - 1) < 1e-9);
    }
    free(a);
    free(b);
    return got;
}

static void test_ms_ssim(void **state)
{
    double got;
    int scales;
    check_ms_ssim(176, 176, 5);
    check_ms_ssim(161, 192, 5); /* sides halve to 161, 81, 41, 21, 11: all boxes at the edge are half empty */
    check_ms_ssim(160, 192, 4);
    check_ms_ssim(21, 44, 2);
    check_ms_ssim(11, 40, 1);
    assert_true(isnan(check_ms_ssim(10, 40, 0)));
    assert_int_equal(adcgs_ms_ssim(NULL, NULL, 0, 5, &got, &scales, NULL), ADCGS_ERR_USAGE);
}

/**
 * A grey image against one with inverted contrast: the structure term is negative and counts as 0. Constant images differ in
 * luminance at the last scale alone.
 */
static void test_ms_ssim_values(void **state)
{
    enum { SIDE = 176 };
    float *a = malloc(3 * SIDE * SIDE * sizeof *a), *b = malloc(3 * SIDE * SIDE * sizeof *b);
    double got;
    int scales;
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        a[i] = random_value();
        b[i] = 1 - a[i];
    }
    assert_int_equal(adcgs_ms_ssim(a, b, SIDE, SIDE, &got, &scales, NULL), ADCGS_OK);
    assert_true(got == 0);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        a[i] = 0.25f;
        b[i] = 0.75f;
    }
    assert_int_equal(adcgs_ms_ssim(a, b, SIDE, SIDE, &got, &scales, NULL), ADCGS_OK);
    assert_true(fabs(got - pow((2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4), 0.1333)) < 1e-9);
    free(a);
    free(b);
}

static double fitted_psnr(const float *a, const float *b, size_t n)
{
    float fitted[150];
    assert_true(3 * n <= ADCGS_COUNTOF(fitted));
    adcgs_fit_levels(fitted, a, b, n);
    return adcgs_psnr(fitted, b, 3 * n);
}

/** An image with another exposure has no error after the fit. Nonlinear errors stay, and unknown pixels do not count. */
static void test_fitted(void **state)
{
    enum { N = 50 };
    float a[3 * N], b[3 * N];
    double off[3 * N], square = 0;
    (void)state;
    for (int i = 0; i < 3 * N; i++) {
        a[i] = (float)(i * 7 % 31) / 31;
        off[i] = i % 2 ? 0.01 : -0.01;
        b[i] = 0.8f * a[i] + 0.1f + 0.02f * (float)(i / N);
    }
    assert_true(fitted_psnr(a, b, N) > 98 && adcgs_psnr(a, b, 3 * N) < 40);
    for (int i = 0; i < 3 * N; i++) {
        b[i] += (float)off[i];
        square += off[i] * off[i] / (3 * N);
    }
    const double bound = adcgs_psnr_from_mse(square), fitted = fitted_psnr(a, b, N);
    assert_true(fitted >= bound && fitted < bound + 1);
    for (int c = 0; c < 3; c++)
        a[c * N] = 100, b[c * N] = NAN;
    assert_true(fabs(fitted_psnr(a, b, N) - fitted) < 0.5);
    for (int i = 0; i < 3 * N; i++)
        a[i] = 0.5f; /* nothing to fit a gain to */
    assert_true(fitted_psnr(a, b, N) < 30);
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

static const adcgs_camera camera = {.width = 64,
                                    .height = 48,
                                    .fx = 40,
                                    .fy = 50,
                                    .cx = 30,
                                    .cy = 20,
                                    .near_plane = 0.1,
                                    .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};

static void expect_rectangle(const adcgs_box *box, const adcgs_camera *c, int left, int top, int right, int bottom)
{
    int r[4];
    assert_int_equal(adcgs_box_rectangle(box, c, r), 1);
    if (r[0] != left || r[1] != top || r[2] != right || r[3] != bottom)
        fail_msg("%d %d %d %d, expected %d %d %d %d", r[0], r[1], r[2], r[3], left, top, right, bottom);
}

static void test_rectangle(void **state)
{
    int r[4];
    /* The face at z = 4 covers x 30 +- 10 and y 20 +- 12.5, the face behind it less. */
    expect_rectangle(&(adcgs_box){{-1, -1, 4}, {1, 1, 9}}, &camera, 20, 7, 40, 33);
    expect_rectangle(&(adcgs_box){{-9, -1, 4}, {1, 9, 9}}, &camera, 0, 7, 40, 48);
    expect_rectangle(&(adcgs_box){{0, 0, 4}, {1e-9, 1e-9, 4.1}}, &camera, 30, 20, 31, 21);
    expect_rectangle(&(adcgs_box){{-1, -1, -1}, {1, 1, 9}}, &camera, 0, 0, 64, 48);  /* around the camera */
    expect_rectangle(&(adcgs_box){{2, -1, -9}, {3, 1, 10}}, &camera, 38, 0, 64, 48); /* from the camera's side to far ahead */
    assert_false(adcgs_box_rectangle(&(adcgs_box){{-1, -1, -9}, {1, 1, -1}}, &camera, r));   /* behind */
    assert_false(adcgs_box_rectangle(&(adcgs_box){{-1, -1, -1}, {1, 1, 0.09}}, &camera, r)); /* nearer than the near plane */
    assert_false(adcgs_box_rectangle(&(adcgs_box){{9, -1, 4}, {10, 1, 5}}, &camera, r));     /* to the right */
    assert_false(adcgs_box_rectangle(&(adcgs_box){{-1, -9, 4}, {1, -8, 5}}, &camera, r));    /* above */
}

/** Bounds of the projected points of a grid inside the box, and the depth of the nearest. */
static double project_grid(const adcgs_box *box, const adcgs_camera *c, double bounds[4])
{
    const double *m = c->cam_to_world;
    double nearest = HUGE_VAL;
    for (int i = 0; i < 40 * 40 * 40; i++) {
        const int at[3] = {i % 40, i / 40 % 40, i / 1600};
        double x[3], p[3];
        for (int a = 0; a < 3; a++)
            x[a] = box->low[a] + (box->high[a] - box->low[a]) * at[a] / 39.0 - m[4 * a + 3];
        for (int a = 0; a < 3; a++)
            p[a] = m[a] * x[0] + m[4 + a] * x[1] + m[8 + a] * x[2];
        const double u = c->fx * p[0] / p[2] + c->cx, v = c->fy * p[1] / p[2] + c->cy;
        nearest = fmin(nearest, p[2]);
        if (p[2] < c->near_plane)
            continue;
        bounds[0] = fmin(bounds[0], u);
        bounds[1] = fmin(bounds[1], v);
        bounds[2] = fmax(bounds[2], u);
        bounds[3] = fmax(bounds[3], v);
    }
    return nearest;
}

static double clip(double x, double most)
{
    return fmin(fmax(x, 0), most);
}

/** For any pose, the rectangle holds all visible points of the grid in the box. If the box is far enough it holds hardly more. */
static void test_any_box(void **state)
{
    int shown = 0;
    for (int round = 0; round < 300; round++) {
        const double angle = 6.3 * (double)random_value();
        const double pose[12] = {cos(angle), 0, sin(angle), 0.3, 0, 1, 0, -0.2, -sin(angle), 0, cos(angle), 0.1};
        double bounds[4] = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
        adcgs_camera c = camera;
        adcgs_box box;
        memcpy(c.cam_to_world, pose, sizeof pose);
        for (int a = 0; a < 3; a++) {
            box.low[a] = 6 * (double)random_value() - 3;
            box.high[a] = box.low[a] + 0.1 + 2 * (double)random_value();
        }
        int r[4];
        const double nearest = project_grid(&box, &c, bounds);
        const int visible = adcgs_box_rectangle(&box, &c, r);
        if (bounds[0] < c.width && bounds[1] < c.height && bounds[2] > 0 && bounds[3] > 0) {
            assert_true(visible);
            for (int i = 0; i < 4; i++) {
                const double edge = clip(bounds[i], i % 2 ? c.height : c.width), beyond = i < 2 ? edge - r[i] : r[i] - edge;
                assert_true(beyond > -1e-9 && (nearest < 0.5 || beyond < 1.001));
            }
            shown++;
        } else if (nearest > 0.5)
            assert_false(visible);
    }
    assert_true(shown > 50);
}

/** Quartile fences by hand: x from 0 to 100 in mixed order, y from -1000 to 0 with one stray point, z the same for all. */
static void test_box_of_points(void **state)
{
    static double position[101][3];
    adcgs_scene scene = {.directory = "scene", .points = {.n = 101, .position = position}};
    adcgs_error error;
    adcgs_box box;
    for (int i = 0; i < 101; i++) {
        position[i][0] = (double)(i * 37 % 101);
        position[i][1] = -10.0 * (double)(i * 29 % 101);
        position[i][2] = 7.0;
    }
    assert_int_equal(adcgs_box_of_points(&box, &scene, &error), ADCGS_OK);
    assert_true(fabs(box.low[0] + 5) < 1e-9 && fabs(box.high[0] - 105) < 1e-9);
    assert_true(fabs(box.low[1] + 1050) < 1e-9 && fabs(box.high[1] - 50) < 1e-9 && box.low[2] == 7 && box.high[2] == 7);
    for (int i = 0; i < 101; i++)
        if (position[i][0] == 100.0)
            position[i][1] = 251.0; /* inside: the quartiles are near -750 and -250 and the fence near 500 */
    assert_int_equal(adcgs_box_of_points(&box, &scene, &error), ADCGS_OK);
    assert_true(box.high[1] > 251 && fabs(box.high[0] - 105) < 1e-9);
    for (int i = 0; i < 101; i++)
        if (position[i][0] == 100.0)
            position[i][1] = 600.0; /* beyond it: the point does not count along the other axes either */
    assert_int_equal(adcgs_box_of_points(&box, &scene, &error), ADCGS_OK);
    assert_true(box.high[1] < 51 && fabs(box.high[0] - (99 + 0.05 * 99)) < 1e-9);
    scene.points.n = 1;
    assert_int_equal(adcgs_box_of_points(&box, &scene, &error), ADCGS_OK);
    assert_true(box.low[0] == 0 && box.high[0] == 0);
    scene.points.n = 0;
    assert_int_equal(adcgs_box_of_points(&box, &scene, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "scene: the scene has no points"));
}

/** Pixels outside of the rectangle do not count. Inside, the figures equal those of the cropped images. */
static void test_crop(void **state)
{
    enum { W = 64, H = 48 };
    static float truth[3 * W * H], decoded[3 * W * H], small_truth[3 * 20 * 26], small_decoded[3 * 20 * 26];
    const adcgs_box box = {{-1, -1, 4}, {1, 1, 9}}, aside = {{9, -1, 4}, {10, 1, 5}}; /* 20..40 x 7..33, as above */
    const adcgs_scene_view view = {.camera = camera};
    const adcgs_view_score score =
        {.view = &view, .seen = &view.camera, .width = W, .height = H, .decoded = decoded, .truth = truth};
    adcgs_crop crop, again;
    double ssim;
    for (int i = 0; i < 3 * W * H; i++) {
        const int c = i / (W * H), y = i / W % H - 7, x = i % W - 20, inside = x >= 0 && x < 20 && y >= 0 && y < 26;
        truth[i] = random_value();
        decoded[i] = inside ? 0.9f * truth[i] + 0.1f * random_value() : random_value();
        if (inside) {
            small_truth[(c * 26 + y) * 20 + x] = truth[i];
            small_decoded[(c * 26 + y) * 20 + x] = decoded[i];
        }
    }
    assert_int_equal(adcgs_crop_measure(&crop, &box, &score, NULL), ADCGS_OK);
    assert_int_equal(adcgs_ssim(small_decoded, small_truth, 20, 26, &ssim, NULL), ADCGS_OK);
    assert_true(crop.visible && crop.ssim == ssim && crop.psnr == adcgs_psnr(small_decoded, small_truth, 3 * 20 * 26));
    for (int i = 0; i < 7 * W + 20; i++)
        decoded[i] = decoded[W * H + i] = 0;
    assert_int_equal(adcgs_crop_measure(&again, &box, &score, NULL), ADCGS_OK);
    assert_true(again.psnr == crop.psnr && again.ssim == crop.ssim);
    assert_int_equal(adcgs_crop_measure(&again, &aside, &score, NULL), ADCGS_OK);
    assert_false(again.visible);
}

/* ---- Amount of detail ---- */

/** Sets values of an image that are equal in all channels. */
static void grey(float *picture, int n, float (*value)(int))
{
    for (int i = 0; i < n; i++)
        picture[i] = picture[n + i] = picture[2 * n + i] = value(i);
}

enum { WIDE = 33, HIGH = 18 }; /* one scale has a column without a partner */

static float shade(int i)
{
    return 0.2f + 0.6f * (float)(i % WIDE) / WIDE;
}

/** Neighbouring pixels differ by 20 levels here and by 10 below. So do details of the finest scale from 0. */
static float strong_stripes(int i)
{
    return 0.5f + (i % WIDE % 2 ? 20.0f : 0.0f) / 255;
}

static float faint_stripes(int i)
{
    return 0.5f + (i % WIDE % 2 ? 10.0f : 0.0f) / 255;
}

/** Two halves, whose edge lies in the middle of the coarsest scale alone. */
static float two_halves(int i)
{
    return i % 32 < 16 ? 0.2f : 0.8f;
}

static uint32_t details_of(float (*value)(int), int width, int height)
{
    static float picture[3 * WIDE * HIGH + 3 * 32 * 32];
    uint32_t n;
    grey(picture, width * height, value);
    assert_int_equal(adcgs_detail(picture, width, height, &n, NULL), ADCGS_OK);
    return n;
}

static void test_detail(void **state)
{
    static float gap[3 * 4] = {0};
    uint32_t n;
    (void)state;
    assert_int_equal(details_of(strong_stripes, WIDE, HIGH), WIDE / 2 * (HIGH / 2));
    assert_int_equal(details_of(faint_stripes, WIDE, HIGH), 0);
    assert_int_equal(details_of(two_halves, 32, 32), 1);
    assert_in_range(details_of(shade, WIDE, HIGH), 1, 60);
    for (int i = 0; i < 12; i++)
        gap[i] = i % 4 ? 0.5f : (float)NAN; /* a masked pixel has no detail */
    assert_int_equal(adcgs_detail(gap, 2, 2, &n, NULL), ADCGS_OK);
    assert_int_equal(n, 0);
    assert_int_equal(adcgs_detail(gap, 1, 4, &n, NULL), ADCGS_OK);
    assert_int_equal(n, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ssim),      cmocka_unit_test(test_ms_ssim), cmocka_unit_test(test_ms_ssim_values),
        cmocka_unit_test(test_fitted),    cmocka_unit_test(test_detail),  cmocka_unit_test(test_psnr),
        cmocka_unit_test(test_rectangle), cmocka_unit_test(test_any_box), cmocka_unit_test(test_box_of_points),
        cmocka_unit_test(test_crop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
