/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Faults of footage in time: gaps, duplicate images, images of another camera; none in free motion and in very short footage.
 */
#include "footage_views.h"

#include "check/faults.h"
#include "train/retime_duplicates.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

/* ---- Very short footage ---- */

static void of_little_nothing_is_said(void **state)
{
    (void)state;
    begin();
    expect_silence(all);
    for (int n = 1; n < 8; n++) { /* one camera with a few identical images; then several at one time */
        begin();
        for (int i = 0; i < n; i++)
            add_view(0, i, 0.0);
        expect_silence(all);
        begin();
        for (int i = 0; i < n; i++)
            add_view(0, 3.0, 0.02 * i * i);
        expect_silence(all);
        begin();
        for (int i = 0; i < n; i++) /* one image per camera */
            add_view(i % CAMERAS, i, 0.0);
        expect_silence(all);
    }
    begin();
    for (int i = 0; i < MOST; i++) { /* all cameras see the same static scene */
        add_view(0, i / CAMERAS, 0.0);
        film.views[i].camera.fx = 50.0 + i % CAMERAS;
    }
    expect_silence(all);
}

static void test_unknown_cells_are_ignored(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < MOST; i++) {
        adcgs_thumbnail *const thumbnail = add_view(i % CAMERAS, i / CAMERAS, draw() * 0.1);
        for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
            if (i % 3 == 0 || k >= 31)
                thumbnail->cells[k] = NAN;
        for (int k = 0; k < ADCGS_THUMBNAIL_TINTS; k++)
            if (i % 3 == 0 || k >= 31)
                thumbnail->tints[0][k] = thumbnail->tints[1][k] = NAN;
    }
    expect_silence(all);
    for (int i = 0; i < MOST; i++) /* no valid number at all */
        memset(&film.thumbnails[i], 0xff, sizeof film.thumbnails[i]);
    expect_silence(all);
}

/* ---- Gaps ---- */

/* One camera with steps of 1, except one step. */
static void film_with_gap(double gap)
{
    begin();
    for (int i = 0; i < 20; i++)
        add_view(0, i < 8 ? i : i - 1 + gap, 0.0);
}

static void gaps_are_found(void **state)
{
    (void)state;
    film_with_gap(2.5);
    expect_silence("g");
    film_with_gap(2.501);
    adcgs_fault fault = find('g');
    assert_true(fault.cameras == 1 && fault.of == 1 && fault.count == 1 && fault.size == 2.0);
    assert_true(fault.from == 7.0 && fabs(fault.to - 9.501) < 1e-9);
    assert_string_equal(fault.path, "7");
    for (int near = 11; near <= 12; near++) { /* of 20 steps, this many are equal: a share of 0.6 is regular */
        double time = 0.0;
        begin();
        for (int i = 0; i <= 20; i++, time += i <= near ? 1.0 : 4.0)
            add_view(0, time, 0.0);
        fault = find('g');
        assert_int_equal(fault.cameras, near == 12);
        assert_true(near != 12 || fault.count == 8);
    }
    begin(); /* six images; then five of one static camera */
    for (int i = 0; i < 6; i++)
        add_view(0, i < 3 ? i : i + 4, 0.0);
    assert_true(find('g').cameras == 1 && find('g').size == 4.0);
    film.n = 5;
    expect_silence("g");
}

static void gaps_of_all_are_the_scenes(void **state)
{
    (void)state;
    begin(); /* cameras in turn: each takes every third frame, and none takes 21 to 23 */
    for (int i = 0; i < MOMENTS; i++)
        if (i <= 20 || i >= 24)
            add_view(i % 3, i, 0.0);
    expect_silence("g"); /* the gap is at most 1.5 times a camera's step */
    begin();
    for (int i = 0; i < MOMENTS; i++)
        if (i <= 20 || i >= 26)
            add_view(i % 3, i, 0.0);
    const adcgs_fault fault = find('g');
    assert_true(fault.cameras == 3 && fault.of == 3 && !fault.path && fault.size == 5.0);
    assert_true(fault.from == 20.0 && fault.to == 26.0);
}

/* For one moving camera, frames set aside for tests do not count as missing. */
static void test_held_out_frames_are_no_gap(void **state)
{
    static adcgs_scene_view aside[4];
    adcgs_scene scene = {.directory = "here", .views = {film.views, NULL, aside}, .n_views = {0, 0, 4}};
    adcgs_fault fault;
    (void)state;
    begin();
    for (int i = 0; i < 20; i++) {
        add_view(0, i < 8 ? i : i + 4, 0.0);
        film.views[i].camera.fx = 50.0 + 0.1 * i;
    }
    scene.n_views[ADCGS_SPLIT_TRAIN] = film.n;
    for (int i = 0; i < 4; i++)
        aside[i].time = 8.0 + i;
    for (uint32_t n = 0; n <= 4; n++) { /* of four frames two are there: half */
        scene.n_views[ADCGS_SPLIT_TEST] = n;
        assert_int_equal(adcgs_fault_gaps(&fault, &scene, &error), ADCGS_OK);
        assert_int_equal(fault.cameras, n < 2);
    }
}

/* ---- Duplicate images ---- */

/* One camera; each image changes by 0.01, but duplicates by `by` times that: `copies` in a row at `pictures` places. */
static void film_twice(int pictures, double by, int copies)
{
    double shown = 0.0, step = 0.01;
    begin();
    for (int i = 0; i < 24; i++) {
        const int at = i % 8, again = i / 8 < pictures && at >= 4 && at < 4 + copies;
        shown += again ? by * step : step;
        add_view(0, i, shown);
    }
}

static void doubled_pictures_are_found(void **state)
{
    (void)state;
    film_twice(2, 0.105, 1);
    expect_silence("d");
    film_twice(2, 0.095, 1);
    adcgs_fault fault = find('d');
    assert_true(fault.cameras == 1 && fault.of == 1 && fault.count == 2 && fault.size == 2.0 && fault.from == 4.0);
    film_twice(1, 0.0, 1); /* a single one may be due to an occlusion */
    expect_silence("d");
    film_twice(3, 0.0, 2);
    fault = find('d');
    assert_true(fault.count == 6);
    film_twice(3, 0.0, 3); /* a run this long means that the scene is at rest */
    expect_silence("d");
}

/* Duplicates are reported, and trained with the timestamp that they show. All other images keep their own. */
static void doubled_pictures_are_of_the_time_before(void **state)
{
    (void)state;
    adcgs_train_view views[MOST];
    const adcgs_scene scene = {.duration = 24.0, .views = {film.views}, .n_views = {24}};
    adcgs_trainer trainer = {.scene = &scene, .views = {.n = 24, .list = views}, .config.retime_duplicates = 1};
    for (int pictures = 1; pictures <= 3; pictures++) {
        film_twice(pictures, 0.0, 2);
        assert_int_equal(adcgs_retime_duplicates(&trainer, film.thumbnails, &error), ADCGS_OK);
        for (int i = 0; i < 24; i++) {
            const int copies = pictures > 1 && i / 8 < pictures && (i % 8 == 4 || i % 8 == 5) ? i % 8 - 3 : 0;
            assert_true(views[i].t == (float)((i - copies) / 24.0));
        }
        assert_int_equal(find('d').count, pictures > 1 ? 2 * pictures : 0);
    }
}

/* A movement to and fro may rest where it turns. */
static void test_oscillation_may_rest(void **state)
{
    (void)state;
    for (int back = 0; back < 2; back++) {
        begin();
        for (int i = 0; i < 24; i++)
            add_view(0, i, 0.01 * (i % 8 < 5 ? i % 8 : back ? 9 - i % 8 : i % 8 - 1));
        assert_int_equal(find('d').cameras, !back);
    }
}

/* One moving camera took all images. A duplicate comes with another pose. */
static void test_duplicates_of_moving_camera(void **state)
{
    (void)state;
    film_twice(2, 0.0, 1);
    for (uint32_t i = 0; i < film.n; i++)
        film.views[i].camera.fx = 50.0 + 0.1 * i;
    assert_int_equal(find('d').count, 2);
    film_twice(0, 0.0, 1);
    for (uint32_t i = 0; i < film.n; i++)
        film.views[i].camera.fx = 50.0 + 0.1 * i;
    expect_silence(all);
    begin(); /* a random camera pose for each image, as in D-NeRF, and only two copies */
    for (int i = 0; i < 40; i++) {
        add_view(i == 11 || i == 22 ? i - 1 : i, i, 0.0);
        film.views[i].camera.fx = 50.0 + 0.1 * i;
    }
    assert_int_equal(find('d').count, 2);
}

/* ---- Images of another camera ---- */

/* Cameras in turn. Image `at` is a copy of the one before, changed by `off`. */
static void film_in_turn(int at, double off, int cameras)
{
    begin();
    for (int i = 0; i < MOMENTS; i++) {
        const int copy = i == at, of = copy ? i - 1 : i;
        add_view(of % cameras, i, 0.002 * of + off * copy);
        film.views[i].camera.fx = 50.0 + i % cameras;
    }
}

static void pictures_of_others_are_found(void **state)
{
    (void)state;
    film_in_turn(-1, 0.0, 4);
    expect_silence(all);
    const double usual = adcgs_thumbnail_difference(&film.thumbnails[21], &film.thumbnails[17]), /* against others */
        other = fmin(adcgs_thumbnail_difference(&film.thumbnails[20], &film.thumbnails[17]),
                     adcgs_thumbnail_difference(&film.thumbnails[20], &film.thumbnails[25]));
    assert_true(usual < 0.1 * other);
    film_in_turn(21, 0.0, 4);
    adcgs_fault fault = find('x');
    assert_true(fault.cameras == 1 && fault.of == 4 && fault.count == 1 && fault.size == 1.0 && fault.to == 21.0);
    assert_string_equal(fault.path, "21");
    film_in_turn(21, 0.09 * other, 4);
    assert_int_equal(find('x').cameras, 1);
    film_in_turn(21, 0.12 * other, 4);
    expect_silence("x");
    for (int at = 4; at < MOMENTS; at++) { /* anywhere except in the first turn, which has no turn before it */
        film_in_turn(at, 0.0, 4);
        assert_true(find('x').size == 1.0 && find('x').to == at);
    }
}

/* Two cameras at one place before a strongly changing scene; then a slate, or a lens cap, before all cameras. */
static void test_common_image_is_no_copy(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < MOMENTS; i++) {
        add_view(0, i, 0.0);
        film.views[i].camera.fx = 50.0 + i % 2;
        for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
            film.thumbnails[i].cells[k] = (float)(0.3 + 0.2 * sin(k * (i / 2 + 1)));
    }
    expect_silence("x");
    film_in_turn(-1, 0.0, 4);
    for (int i = 20; i < 24; i++)
        for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
            film.thumbnails[i].cells[k] = 0.001f * (float)(k % 2);
    expect_silence("x");
}

/* ---- Free motion ---- */

/*
 * Blobs on smooth paths, seen by cameras from different places with sensor noise. Every frame is seen by one in `turns` cameras.
 */
static void film_anything(uint32_t seed, int cameras, int turns, int moves)
{
    double way[4][8];
    random_state = seed * 7919u + 1u;
    for (int b = 0; b < 4; b++)
        for (int k = 0; k < 8; k++)
            way[b][k] = draw();
    begin();
    for (int i = 0; i < MOMENTS; i++)
        for (int k = 0; k < cameras / turns; k++) {
            const int c = (i + k * turns) % cameras;
            adcgs_thumbnail *const thumbnail = add_view(moves ? 0 : c, i, 0.0);
            film.views[film.n - 1].camera.fx = 50.0 + (moves ? 0.01 * i : c);
            for (int b = 0; b < 4; b++) {
                const double t = (double)i / MOMENTS, *w = way[b];
                const double x = 16 + 12 * sin(6.2832 * (w[0] + 3 * w[1] * t)) + 2 * c + (moves ? 0.2 * i : 0);
                const double y = 16 + 12 * sin(6.2832 * (w[2] + 3 * w[3] * t)), r = 2 + 4 * w[4];
                for (int p = 0; p < ADCGS_THUMBNAIL_CELLS; p++) {
                    const double dx = p % ADCGS_THUMBNAIL_SIDE - x, dy = p / ADCGS_THUMBNAIL_SIDE - y;
                    const double share = 1.0 / (1.0 + exp(2.0 * (sqrt(dx * dx + dy * dy) - r)));
                    thumbnail->cells[p] += (float)(share * (w[5] - 0.5));
                    thumbnail->tints[0][p % ADCGS_THUMBNAIL_TINTS] += (float)(share * (w[6] - 0.5));
                    thumbnail->tints[1][p % ADCGS_THUMBNAIL_TINTS] += (float)(share * (w[7] - 0.5));
                }
            }
            for (int p = 0; p < ADCGS_THUMBNAIL_CELLS; p++)
                thumbnail->cells[p] += (float)(0.002 * (draw() - 0.5));
        }
}

static void test_random_motion_has_no_fault(void **state)
{
    (void)state;
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        film_anything(seed, 4, 1 + (int)(seed % 2) * 3, 0); /* all cameras see each frame, or they take turns */
        expect_silence(all);
        film_anything(seed, 1, 1, (int)(seed % 2)); /* one camera, static or moving */
        expect_silence(all);
    }
}

/**
 * Masked pixels, which are NaN in images, have no effect. A bright sign over most of the image is no step of light and hides
 * none. Two images that differ in the sign alone are duplicates.
 */
static void test_masked_pixels_are_ignored(void **state)
{
    enum { SIDE = 64, PLANE = SIDE * SIDE };
    static float rgb[2][3 * PLANE];
    adcgs_thumbnail thumbnails[2];
    double spread;
    (void)state;
    for (int masked = 0; masked < 2; masked++)
        for (int brighter = 0; brighter < 2; brighter++) {
            for (int p = 0; p < 2; p++) {
                for (int i = 0; i < 3 * PLANE; i++) {
                    const int sign = i % SIDE < 3 * SIDE / 4;
                    const double shade = 0.2 + 0.1 * (i % 7) / 7.0, gain = p ? sign ? 2.0 : 1.0 + 0.25 * brighter : 1.0;
                    rgb[p][i] = sign && masked ? NAN : (float)(shade * gain);
                }
                adcgs_thumbnail_compute(&thumbnails[p], rgb[p], SIDE, SIDE);
            }
            const double step = exp(adcgs_thumbnail_compare(&thumbnails[0], &thumbnails[1], ADCGS_LIGHT_BRIGHTER, &spread));
            const double expected = !masked ? 2.0 : 1.0 + 0.25 * brighter;
            assert_true(fabs(step - expected) < 1e-3 && (!masked || spread < 1e-3));
            if (masked && !brighter)
                assert_true(adcgs_thumbnail_difference(&thumbnails[0], &thumbnails[1]) < 1e-6);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_little_nothing_is_said),
        cmocka_unit_test(test_unknown_cells_are_ignored),
        cmocka_unit_test(gaps_are_found),
        cmocka_unit_test(gaps_of_all_are_the_scenes),
        cmocka_unit_test(test_held_out_frames_are_no_gap),
        cmocka_unit_test(doubled_pictures_are_found),
        cmocka_unit_test(doubled_pictures_are_of_the_time_before),
        cmocka_unit_test(test_oscillation_may_rest),
        cmocka_unit_test(test_duplicates_of_moving_camera),
        cmocka_unit_test(pictures_of_others_are_found),
        cmocka_unit_test(test_common_image_is_no_copy),
        cmocka_unit_test(test_random_motion_has_no_fault),
        cmocka_unit_test(test_masked_pixels_are_ignored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
