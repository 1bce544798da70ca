/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality over time, against plain loops over whole videos and values known beforehand; views sorted by camera. */
#include "metric/changes.h"
#include "metric/metric.h"
#include "metric/temporal.h"
#include "scene/group_views.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

enum { W = 40, H = 30, PLANE = W * H, VALUES = 3 * PLANE, FRAMES = 6 };

typedef float video[FRAMES][VALUES];

static video truth, decoded;
static adcgs_error error;
static uint32_t seed = 7;

static float random_value(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) / 16777216.0f;
}

/** A white square of 4x4 moves to the right by two pixels per image before grey. Its path covers x 8 to 21, y 10 to 13. */
static void draw_square(void)
{
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < VALUES; i++) {
            const int x = i % W - 8 - 2 * t, y = i % PLANE / W - 10;
            truth[t][i] = x >= 0 && x < 4 && y >= 0 && y < 4 ? 1.0f : 0.5f;
        }
    memcpy(decoded, truth, sizeof truth);
}

/**
 * Pixels for which most of the 5x5 square about them lies on that path: x 10 to 19 in its outer rows, x 9 to 20 in its inner
 * rows. The region reaches three pixels farther.
 */
static int is_near_square(int pixel)
{
    const int x = pixel % W, y = pixel / W;
    return (x >= 9 - 3 && x <= 20 + 3 && y >= 11 - 3 && y <= 12 + 3) ||
           (x >= 10 - 3 && x <= 19 + 3 && y >= 10 - 3 && y <= 13 + 3);
}

/** Measures both videos. */
static adcgs_temporal_total measure(adcgs_temporal_view views[FRAMES], uint8_t region[PLANE])
{
    adcgs_temporal *t;
    assert_int_equal(adcgs_temporal_create(&t, W, H, &error), ADCGS_OK);
    for (int i = FRAMES - 1; i >= 0; i--)
        adcgs_temporal_look(t, truth[i]);
    assert_int_equal(adcgs_temporal_find_region(t, &error), ADCGS_OK);
    memcpy(region, adcgs_temporal_region(t), PLANE);
    for (int i = 0; i < FRAMES; i++)
        views[i] = adcgs_temporal_add(t, decoded[i], truth[i]);
    const adcgs_temporal_total total = adcgs_temporal_end(t);
    adcgs_temporal_free(&t);
    assert_null(t);
    assert_int_equal(total.views, FRAMES);
    return total;
}

static void expect_near(double got, double expected)
{
    if (!(fabs(got - expected) <= 1e-12 + 1e-9 * fabs(expected)))
        fail_msg("%.15g, expected %.15g", got, expected);
}

/** Exactly the path of the square is dynamic, and identical videos are perfect. */
static void test_square(void **state)
{
    adcgs_temporal_view views[FRAMES];
    uint8_t region[PLANE];
    draw_square();
    const adcgs_temporal_total total = measure(views, region);
    for (int i = 0; i < PLANE; i++)
        assert_int_equal(region[i], is_near_square(i));
    expect_near(total.dynamic_share, (18.0 * 8 + 16 * 2) / PLANE);
    assert_true(total.static_variance == 0 && total.truth_variance == 0);
    for (int t = 0; t < FRAMES; t++)
        assert_true(views[t].dynamic_psnr == 99 && (t ? views[t].flicker == 0 : isnan(views[t].flicker)));
}

/** A constant error causes neither flicker nor variance, and only the error inside the region counts as dynamic. */
static void test_constant_shift(void **state)
{
    adcgs_temporal_view views[FRAMES];
    uint8_t region[PLANE];
    draw_square();
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < VALUES; i++)
            decoded[t][i] += is_near_square(i % PLANE) ? 0.125f : 0.25f;
    const adcgs_temporal_total total = measure(views, region);
    assert_true(total.static_variance == 0 && total.truth_variance == 0);
    for (int t = 0; t < FRAMES; t++) {
        expect_near(views[t].dynamic_psnr, -20 * log10(0.125));
        assert_true(!t || views[t].flicker == 0);
    }
}

/** Every second image is brighter by an eighth: closed forms. */
static void test_blinking(void **state)
{
    adcgs_temporal_view views[FRAMES];
    uint8_t region[PLANE];
    draw_square();
    for (int t = 1; t < FRAMES; t += 2)
        for (int i = 0; i < VALUES; i++)
            decoded[t][i] += 0.125f;
    const adcgs_temporal_total total = measure(views, region);
    expect_near(total.static_variance, 0.0625 * 0.0625);
    assert_true(total.truth_variance == 0);
    for (int t = 0; t < FRAMES; t++) {
        expect_near(views[t].dynamic_psnr, t % 2 ? -20 * log10(0.125) : 99);
        assert_true(!t || views[t].flicker == 0.125);
    }
    /* The first channel of the truth blinks, by less than a change that counts. Then the third blinks too, by more. */
    for (int t = 1; t < FRAMES; t += 2)
        for (int i = 0; i < PLANE; i++)
            truth[t][i] += 0.09375f;
    expect_near(measure(views, region).truth_variance, 0.09375 * 0.09375 / 4 / 3);
    assert_false(region[0]);
    for (int t = 1; t < FRAMES; t += 2)
        for (int i = 2 * PLANE; i < VALUES; i++)
            truth[t][i] += 0.125f;
    const adcgs_temporal_total none = measure(views, region);
    assert_true(none.dynamic_share == 1 && isnan(none.static_variance) && isnan(none.truth_variance));
}

static void test_still(void **state)
{
    adcgs_temporal_view views[FRAMES];
    uint8_t region[PLANE];
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < VALUES; i++) {
            truth[t][i] = (float)(i % 7) / 8;
            decoded[t][i] = 0.5f;
        }
    const adcgs_temporal_total total = measure(views, region);
    assert_true(total.dynamic_share == 0 && total.static_variance == 0 && total.truth_variance == 0);
    for (int t = 0; t < FRAMES; t++)
        assert_true(isnan(views[t].dynamic_psnr) && (!t || views[t].flicker == 0));
}

static int changes(int pixel)
{
    for (int c = 0; c < 3; c++)
        for (int t = 0; t < FRAMES * FRAMES; t++)
            if ((double)truth[t / FRAMES][c * PLANE + pixel] - (double)truth[t % FRAMES][c * PLANE + pixel] > 0.1)
                return 1;
    return 0;
}

static int is_within(int a, int b, int reach)
{
    return abs(a % W - b % W) <= reach && abs(a / W - b / W) <= reach;
}

/** The region by its definition: true near any pixel with more changing neighbours than static ones. */
static void reference_region(uint8_t region[PLANE])
{
    memset(region, 0, PLANE);
    for (int i = 0; i < PLANE; i++) {
        int more = 0;
        for (int j = 0; j < PLANE; j++)
            if (is_within(i, j, 2))
                more += changes(j) ? 1 : -1;
        for (int j = 0; more > 0 && j < PLANE; j++)
            region[j] |= is_within(i, j, 3);
    }
}

/** Mean variance of a video over the static values, in two passes over each. */
static double reference_variance(video v, const uint8_t region[PLANE])
{
    double sum = 0, n = 0;
    for (int i = 0; i < VALUES; i++) {
        double mean = 0, square = 0;
        for (int t = 0; t < FRAMES; t++)
            mean += (double)v[t][i] / FRAMES;
        for (int t = 0; t < FRAMES; t++)
            square += ((double)v[t][i] - mean) * ((double)v[t][i] - mean) / FRAMES;
        sum += region[i % PLANE] ? 0 : square;
        n += !region[i % PLANE];
    }
    return sum / n;
}

static double reference_dynamic_psnr(int t, const uint8_t region[PLANE])
{
    double sum = 0, n = 0;
    for (int i = 0; i < VALUES; i++)
        if (region[i % PLANE]) {
            sum += pow((double)decoded[t][i] - (double)truth[t][i], 2);
            n++;
        }
    return 10 * log10(n / sum);
}

static double reference_flicker(int t)
{
    double sum = 0;
    for (int i = 0; i < VALUES; i++) {
        const double drawn = (double)decoded[t][i] - (double)decoded[t - 1][i];
        sum += fabs(drawn - ((double)truth[t][i] - (double)truth[t - 1][i]));
    }
    return sum / VALUES;
}

/** True if a value is at a place with strong noise: a corner, two edges, and a single pixel. */
static int is_far(int i)
{
    const int x = i % W, y = i % PLANE / W, c = i / PLANE;
    return (x < 3 && y < 2 && c == 0) || (x >= W - 2 && y >= 8 && y < 12 && c == 1) ||
           (x >= 5 && x < 10 && y >= H - 2 && c == 2) || (x == 20 && y == 17);
}

/** Noise at each place, stronger at some. */
static void test_against_reference(void **state)
{
    adcgs_temporal_view views[FRAMES];
    uint8_t region[PLANE], expected[PLANE];
    for (int t = 0; t < FRAMES; t++)
        for (int i = 0; i < VALUES; i++) {
            truth[t][i] = (float)(i % 11) / 16 + (is_far(i) ? 0.8f : 0.09f) * random_value();
            decoded[t][i] = truth[t][i] + 0.2f * random_value() - 0.1f;
        }
    const adcgs_temporal_total total = measure(views, region);
    reference_region(expected);
    assert_memory_equal(region, expected, PLANE);
    assert_true(region[0] && region[10 * W + W - 1] && region[(H - 1) * W + 7] && !region[17 * W + 20]);
    expect_near(total.static_variance, reference_variance(decoded, region));
    expect_near(total.truth_variance, reference_variance(truth, region));
    for (int t = 0; t < FRAMES; t++) {
        expect_near(views[t].dynamic_psnr, reference_dynamic_psnr(t, region));
        if (t)
            expect_near(views[t].flicker, reference_flicker(t));
    }
}

/** Cameras a and b take turns, backwards in time, and c moves. A difference in any number makes another camera. */
static void test_cameras(void **state)
{
    static const uint32_t expected_of[8] = {0, 1, 2, 0, 1, 3, 0, 4}, expected_order[8] = {6, 3, 0, 4, 1, 2, 5, 7};
    adcgs_scene_view views[8] = {{.time = 0}};
    uint32_t of[8], order[8], n;
    for (int i = 0; i < 8; i++)
        views[i] = (adcgs_scene_view){.camera = {.width = 8, .height = 8, .fx = 9, .fy = 9, .cx = 4, .cy = 4}, .time = 8 - i};
    views[1].camera.cam_to_world[11] = views[4].camera.cam_to_world[11] = -3;
    views[2].camera.cx = 5;
    views[5].camera.height = 7;
    views[7].camera.fy = nextafter(9, 10);
    strcpy(views[3].camera.name, "other"); /* names belong to images */
    assert_int_equal(adcgs_group_views(views, 8, of, order, &n, &error), ADCGS_OK);
    assert_int_equal(n, 5);
    assert_memory_equal(of, expected_of, sizeof of);
    assert_memory_equal(order, expected_order, sizeof order);
    for (int i = 0; i < 8; i++)
        views[i].time = 1;
    assert_int_equal(adcgs_group_views(views, 8, of, order, &n, &error), ADCGS_OK);
    assert_true(order[0] == 0 && order[1] == 3 && order[2] == 6 && order[3] == 1);
    assert_int_equal(adcgs_group_views(views, 8, of, NULL, &n, &error), ADCGS_OK);
    assert_memory_equal(of, expected_of, sizeof of);
    assert_int_equal(adcgs_group_views(NULL, 0, of, NULL, &n, &error), ADCGS_OK);
    assert_int_equal(n, 0);
}

/* ---- Threshold of changes ---- */

enum { MANY = 24 };

/** Nearly normal, of variance 1. */
static float normal_value(void)
{
    float sum = -6;
    for (int i = 0; i < 12; i++)
        sum += random_value();
    return sum;
}

/** Grey with noise; the first `part` values brighten by `growth` over all images. The last one is masked every second time. */
static adcgs_changes *make_changes(float noise, float growth, int part)
{
    static float picture[VALUES];
    adcgs_changes *c;
    assert_int_equal(adcgs_changes_create(&c, W, H, &error), ADCGS_OK);
    for (int t = 0; t < MANY; t++) {
        for (int i = 0; i < VALUES; i++)
            picture[i] = 0.4f + noise * normal_value() + (i < part ? growth * (float)t / (MANY - 1) : 0);
        if (t % 2)
            picture[VALUES - 1] = NAN;
        adcgs_changes_add(c, picture);
    }
    return c;
}

static void test_noise(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double noise = (double[]){0.002, 0.005, 0.01}[i];
        adcgs_changes *still = make_changes((float)noise, 0, 0), *slow = make_changes((float)noise, 0.02f, VALUES);
        const double found = adcgs_changes_noise(still);
        assert_true(found > 0.4 * noise && found < noise);
        assert_true(fabs(adcgs_changes_noise(slow) / found - 1) < 0.3); /* slow changes do not count as noise */
        adcgs_changes_free(&still);
        adcgs_changes_free(&slow);
    }
}

/** A slow change, too small to count as motion, counts only where following it is worthwhile. */
static void test_worth(void **state)
{
    (void)state;
    const double square = 0.08 * 0.08 / 12; /* mean square of a value that grows by 0.08 */
    adcgs_changes *c = make_changes(0.001f, 0.08f, VALUES);
    assert_true(adcgs_changes_least(c, 0.02, 8 * square) == ADCGS_CHANGE_LEAST);
    assert_true(adcgs_changes_least(c, 0.02, square) < 0.06);
    assert_true(adcgs_changes_least(c, 0.07, square) == 0.07); /* never below the visible change */
    adcgs_changes_free(&c);
    c = make_changes(0.001f, 0.08f, VALUES / 50); /* it is found among static values, too */
    assert_true(adcgs_changes_least(c, 0.02, square) < 0.06);
    adcgs_changes_free(&c);
    c = make_changes(0.001f, 0.08f, 0);
    assert_true(adcgs_changes_least(c, 0.02, 1e-4) == ADCGS_CHANGE_LEAST); /* nothing to follow */
    adcgs_changes_free(&c);
    c = make_changes(0.015f, 0.08f, VALUES / 2);
    assert_true(adcgs_changes_least(c, 0.02, 1e-9) > 0.03); /* noise is not followed */
    adcgs_changes_free(&c);
}

/** The region holds changes and their surroundings: a single pixel if the change is large, several pixels if it is smaller. */
static void test_changing_region(void **state)
{
    (void)state;
    static float picture[VALUES];
    uint8_t region[PLANE];
    adcgs_changes *c;
    assert_int_equal(adcgs_changes_create(&c, W, H, &error), ADCGS_OK);
    for (int t = 0; t < MANY; t++) {
        for (int i = 0; i < VALUES; i++)
            picture[i] = 0.4f + 0.002f * normal_value();
        if (t == 7)
            picture[10 * W + 5] += 0.2f; /* red of one pixel */
        if (t == 8)
            picture[PLANE + 10 * W + 20] += 0.12f; /* green of one pixel, by less */
        for (int i = 0; t == 9 && i < 25; i++)
            picture[2 * PLANE + (20 + i / 5) * W + 30 + i % 5] += 0.12f; /* blue of several pixels */
        adcgs_changes_add(c, picture);
    }
    assert_int_equal(adcgs_changes_region(c, 0.1, region, &error), ADCGS_OK);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int at = region[y * W + x];
            if (abs(x - 5) <= 3 && abs(y - 10) <= 3)
                assert_int_equal(at, 1);
            else if (abs(x - 32) > 5 || abs(y - 22) > 5)
                assert_int_equal(at, 0);
            else if (abs(x - 32) <= 2 && abs(y - 22) <= 2)
                assert_int_equal(at, 1);
        }
    adcgs_changes_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_square),
        cmocka_unit_test(test_constant_shift),
        cmocka_unit_test(test_blinking),
        cmocka_unit_test(test_still),
        cmocka_unit_test(test_against_reference),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_worth),
        cmocka_unit_test(test_changing_region),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
