/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Lenses: the model and its inverse, pinhole cameras for them. */
#include "lens_reference.h"
#include "second_sources.h"

#include "scene/lens_model.h"

#include <math.h>

/* ---- The model ---- */

static void test_projection(void **state)
{
    /* By hand: r^2 = 0.25 + 0.0625 = 0.3125; factor 1 + 0.1 r^2 = 1.03125; x' = 0.515625 + 2 p1 xy + p2 (r^2 + 2 x^2). */
    const adcgs_lens plain =
        {.width = 10, .height = 10, .fx = 100, .fy = 200, .cx = 5, .cy = 7, .skew = 10, .k = {0.1}, .p = {0.01, 0.02}};
    double uv[2], expected[2];
    adcgs_lens_project(&plain, 0.5, 0.25, uv);
    assert_true(fabs(uv[0] - (100 * (0.515625 + 0.0025 + 0.01625) + 10 * (0.2578125 + 0.004375 + 0.005) + 5)) < 1e-12);
    assert_true(fabs(uv[1] - (200 * (0.2578125 + 0.004375 + 0.005) + 7)) < 1e-12);
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++)
        for (int i = -10; i <= 10; i++)
            for (int j = -10; j <= 10; j++) {
                adcgs_lens_project(&lenses[n], 0.1 * i, 0.1 * j, uv);
                reference(&lenses[n], 0.1 * i, 0.1 * j, expected);
                assert_true(fabs(uv[0] - expected[0]) < 1e-9 && fabs(uv[1] - expected[1]) < 1e-9);
            }
}

/** Projection inverts unprojection over the whole image, edges included. Directions increase along rows: one branch only. */
static void test_inverse(void **state)
{
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++)
        for (int j = 0; j <= 40; j++) {
            double before = -HUGE_VAL;
            for (int i = 0; i <= 40; i++) {
                const double u = lenses[n].width * i / 40.0, v = lenses[n].height * j / 40.0;
                double xy[2], uv[2];
                assert_true(unproject(&lenses[n], u, v, xy));
                adcgs_lens_project(&lenses[n], xy[0], xy[1], uv);
                assert_true(fabs(uv[0] - u) < 1e-8 && fabs(uv[1] - v) < 1e-8);
                assert_true(xy[0] > before);
                before = xy[0];
            }
        }
}

/** r - r^3 grows until r = 1/sqrt(3), where it is 2/(3 sqrt(3)). Nothing is seen further out; the inverse is the near branch. */
static void test_fold(void **state)
{
    adcgs_lens fold = {.width = 74, .height = 10, .fx = 100, .fy = 100, .cx = 37, .cy = 5, .k = {-1.0}};
    const double most = 100.0 * 2.0 / (3.0 * sqrt(3.0));
    adcgs_camera camera = {0};
    double xy[2];
    for (int turn = 0; turn < 8; turn++) {
        const double c = cos(turn), s = sin(turn);
        assert_true(unproject(&fold, 37 + c * (most - 1e-3), 5 + s * (most - 1e-3), xy));
        assert_true(hypot(xy[0], xy[1]) < 1.0 / sqrt(3.0) && hypot(xy[0], xy[1]) > 0.57);
        assert_false(unproject(&fold, 37 + c * (most + 1e-3), 5 + s * (most + 1e-3), xy));
    }
    expect_good(adcgs_lens_pinhole(&fold, &camera, "x", &error)); /* corners at 37.3 pixels */
    assert_true(camera.width > 74);
    fold.width = 80;
    fold.cx = 40;
    expect_error(adcgs_lens_pinhole(&fold, &camera, "some.json", &error), ADCGS_ERR_DATA, "some.json: ", "folds inside");
    /* The model would grow again further out. The first fold counts. */
    fold.k[1] = 10.0;
    fold.k[0] = -5.0;
    assert_true(unproject(&fold, 41, 5, xy) && xy[0] < 0.05);
    assert_false(unproject(&fold, 40 + 40, 5, xy));
    /* A pole: 1/(1 - r^2) reaches every place in the image before r is 1. */
    const adcgs_lens pole = {.width = 80, .height = 10, .fx = 10, .fy = 10, .cx = 40, .cy = 5, .k = {0, 0, 0, -1.0}};
    assert_true(unproject(&pole, 80, 5, xy) && xy[0] < 1.0);
    /* Tangential terms fold too. */
    adcgs_lens bent = {.width = 80, .height = 80, .fx = 40, .fy = 40, .cx = 40, .cy = 40, .p = {0.3, 0}};
    expect_error(adcgs_lens_pinhole(&bent, &camera, "x", &error), ADCGS_ERR_DATA, "x: ", "folds inside");
}

/** The inverse exists up to 89.4 degrees from the axis and not beyond. */
static void test_angles(void **state)
{
    const adcgs_lens circle = CIRCLE;
    double uv[2], xy[2];
    for (int turn = 0; turn < 12; turn++)
        for (int tenth = 0; tenth < 894; tenth++) {
            const double angle = tenth * 0.1 * M_PI / 180.0, x = tan(angle) * cos(turn), y = tan(angle) * sin(turn);
            reference(&circle, x, y, uv);
            assert_true(unproject(&circle, uv[0], uv[1], xy));
            assert_true(fabs(atan(hypot(xy[0], xy[1])) - angle) < 1e-10);
            assert_true(hypot(xy[0] - x, xy[1] - y) < 1e-9 * (1.0 + x * x + y * y));
        }
    reference(&circle, 1e9, 0, uv);
    assert_false(unproject(&circle, uv[0], uv[1], xy)); /* 90 degrees */
    assert_false(unproject(&circle, uv[0] + 20, uv[1], xy));
    adcgs_lens_project(&circle, 0.0, 0.0, uv);
    assert_true(uv[0] == circle.cx && uv[1] == circle.cy);
}

/** A fold of the model is an error only inside the image, or inside the part that the pinhole keeps. */
static void test_fisheye_folds(void **state)
{
    /* a - a^3 / 3 k grows up to a = sqrt(k). */
    adcgs_lens lens = {.width = 400, .height = 400, .fx = 100, .fy = 100, .cx = 200, .cy = 200, .is_fisheye = 1};
    adcgs_camera c = {0};
    const double corner = atan(sqrt(6.0)); /* of the part that the pinhole keeps */
    lens.k[0] = -1.0 / (3.0 * pow(corner + 0.01, 2));
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    lens.k[0] = -1.0 / (3.0 * pow(corner - 0.01, 2));
    expect_error(adcgs_lens_pinhole(&lens, &c, "cams.json", &error), ADCGS_ERR_DATA, "cams.json: ", "folds inside");
    lens.width = lens.height = 60; /* half the fold's radius reaches this corner, 42 pixels from the axis at focal length 100 */
    lens.cx = lens.cy = 30;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    lens.k[0] = -3.0;
    expect_error(adcgs_lens_pinhole(&lens, &c, "x", &error), ADCGS_ERR_DATA, "x: ", "folds inside");
}

static void test_nonsense(void **state)
{
    static const double values[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e300, 1e17, -1e17, 1e6, 0.0};
    double xy[2];
    for (size_t i = 0; i < ADCGS_COUNTOF(values); i++)
        for (size_t field = 2; field < 2 * sizeof(adcgs_lens) / sizeof(double); field++) {
            adcgs_lens lens = field % 2 ? (adcgs_lens)CROOKED : (adcgs_lens)FISHEYE;
            adcgs_camera camera = {0};
            memcpy((char *)&lens + field / 2 * sizeof(double), &values[i], sizeof(double));
            error = (adcgs_error){0};
            (void)unproject(&lens, 3, 4, xy);
            if (adcgs_lens_pinhole(&lens, &camera, "x", &error) == ADCGS_OK)
                assert_true(camera.width >= 1 && camera.width <= ADCGS_IMAGE_MAX && camera.height >= 1 &&
                            camera.height <= ADCGS_IMAGE_MAX);
            else
                assert_true(error.status == ADCGS_ERR_DATA && error.text[0]);
        }
}

/* ---- Pinholes ---- */

/** True if the lens's image shows the pinhole camera's pixel. */
static int is_shown(const adcgs_lens *lens, const adcgs_camera *c, double u, double v)
{
    double uv[2], back[2];
    const double x = (u - c->cx) / c->fx, y = (v - c->cy) / c->fy;
    reference(lens, x, y, uv);
    if (!(uv[0] >= -1e-5 && uv[1] >= -1e-5 && uv[0] <= lens->width + 1e-5 && uv[1] <= lens->height + 1e-5))
        return 0;
    return unproject(lens, uv[0], uv[1], back) && hypot(back[0] - x, back[1] - y) < 1e-7; /* not beyond a fold */
}

/** All corners of pixels are shown, and no side could be extended by a whole row or column. */
static void test_coverage(void **state)
{
    for (size_t n = 0; n < ADCGS_COUNTOF(lenses); n++) {
        adcgs_lens lens = lenses[n];
        adcgs_camera c = {0};
        int beyond[4] = {1, 1, 1, 1};
        expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
        assert_true(lens.width == lenses[n].width && c.fx == lens.fx && c.fy == lens.fy);
        assert_true(c.cx - lens.cx == floor(c.cx - lens.cx) && c.cy - lens.cy == floor(c.cy - lens.cy));
        for (int j = 0; j <= c.height; j++)
            for (int i = 0; i <= c.width; i++)
                assert_true(is_shown(&lens, &c, i, j));
        for (int j = 0; j <= c.height; j++) {
            beyond[0] &= is_shown(&lens, &c, -1, j);
            beyond[1] &= is_shown(&lens, &c, c.width + 1, j);
        }
        for (int i = 0; i <= c.width; i++) {
            beyond[2] &= is_shown(&lens, &c, i, -1);
            beyond[3] &= is_shown(&lens, &c, i, c.height + 1);
        }
        assert_false(beyond[0] || beyond[1] || beyond[2] || beyond[3]);
    }
}

/** The area of the largest rectangle, by exhaustive search: shown[j][i] counts the covered places in a row up to there. */
static int largest_by_trying(const adcgs_lens *lens)
{
    enum { LOW = -40, N = 160 };
    static int shown[N][N];
    const adcgs_camera plane = {.fx = lens->fx, .fy = lens->fy, .cx = lens->cx, .cy = lens->cy};
    int best = 0;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            shown[j][i] = is_shown(lens, &plane, i + LOW, j + LOW) ? (i ? shown[j][i - 1] : 0) + 1 : 0;
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            for (int down = j, least = N; down < N; down++) {
                least = ADCGS_MIN(least, shown[down][i]);
                best = ADCGS_MAX(best, (least - 1) * (down - j));
            }
    return best;
}

static void test_largest(void **state)
{
    static const adcgs_lens small[] = {
        {.width = 60, .height = 40, .fx = 40, .fy = 40, .cx = 25, .cy = 23, .k = {-0.25, 0.07}},
        {.width = 60, .height = 40, .fx = 60, .fy = 50, .cx = 30, .cy = 20, .k = {0.2, 0.1}, .p = {0.01, -0.01}},
        {.width = 80, .height = 70, .fx = 60, .fy = 60, .cx = 40, .cy = 35, .skew = 30},
        {.width = 50, .height = 50, .fx = 190, .fy = 190, .cx = -20, .cy = 70, .k = {-0.3}},
    };
    for (size_t n = 0; n < ADCGS_COUNTOF(small); n++) {
        adcgs_lens lens = small[n];
        adcgs_camera c = {0};
        expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
        assert_int_equal(c.width * c.height, largest_by_trying(&small[n]));
    }
}

/** The part of a circular image that the pinhole keeps. */
static void test_circle(void **state)
{
    adcgs_lens lens = CIRCLE;
    adcgs_camera c = {0};
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_true(c.fx == 100 && c.fy == 101 && lens.width == 400);
    assert_true(c.width == 2 * floor(100 * sqrt(3)) && c.cx == floor(100 * sqrt(3))); /* 60 degrees to each side */
    assert_true(c.height - c.cy > 90 && c.height - c.cy < floor(101 * sqrt(3)));      /* below the axis the image ends earlier */
    assert_true(c.cy == floor(101 * sqrt(3)));
    for (int j = 0; j <= c.height; j++)
        for (int i = 0; i <= c.width; i++)
            assert_true(is_shown(&lens, &c, i, j));
}

static void test_flat(void **state)
{
    adcgs_lens lens = {.width = 60, .height = 40, .fx = 50, .fy = 51, .cx = 29, .cy = 18};
    adcgs_camera c = {.near_plane = 3, .name = "kept"};
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_true(lens.width == 0 && c.width == 60 && c.height == 40 && c.fx == 50 && c.fy == 51 && c.cx == 29 && c.cy == 18);
    assert_true(c.near_plane == 3 && !strcmp(c.name, "kept"));
    lens.width = 60;
    lens.k[0] = 1e-4; /* moves the corner by less than a hundredth of a pixel */
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_int_equal(lens.width, 0);
    lens.width = 60;
    lens.k[0] = 1e-2;
    expect_good(adcgs_lens_pinhole(&lens, &c, "x", &error));
    assert_int_equal(lens.width, 60);
    /* A shear so steep that less than a tenth is left. */
    lens = (adcgs_lens){.width = 60, .height = 40, .fx = 50, .fy = 50, .cx = 30, .cy = 20, .skew = 1000};
    expect_error(adcgs_lens_pinhole(&lens, &c, "cam.json", &error), ADCGS_ERR_DATA, "cam.json: ", "a tenth");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projection), cmocka_unit_test(test_inverse),       cmocka_unit_test(test_fold),
        cmocka_unit_test(test_angles),     cmocka_unit_test(test_fisheye_folds), cmocka_unit_test(test_circle),
        cmocka_unit_test(test_nonsense),   cmocka_unit_test(test_coverage),      cmocka_unit_test(test_largest),
        cmocka_unit_test(test_flat),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    failed += adcgs_test_lens_images();
    return failed;
}
