/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Faults of footage, on thumbnail statistics of synthetic images. Each fault is found at its threshold and not just below it.
 * Free motion, and very short or empty footage, cause no report.
 */
#include "data/faults.h"
#include "data/light.h"
#include "train/retime_duplicates.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

enum { CAMERAS = 6, MOMENTS = 48, MOST = CAMERAS * MOMENTS, SEEDS = 100 };

static adcgs_error error;

/* The recorded footage. A view's path is its number. */
static struct {
    uint32_t n;
    adcgs_scene_view views[MOST];
    adcgs_thumbnail thumbnails[MOST];
    char names[MOST][8];
} film;

static uint32_t random_state;

static double draw(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (double)(random_state >> 8) / 16777216.0;
}

/* An image by a camera, in shades of its own (0.3 to 0.6, made brighter by the last argument) and plain tints. */
static adcgs_thumbnail *add_view(int camera, double time, double brighter)
{
    adcgs_scene_view *const view = &film.views[film.n];
    adcgs_thumbnail *const thumbnail = &film.thumbnails[film.n];
    assert_true(film.n < MOST);
    snprintf(film.names[film.n], sizeof film.names[0], "%u", film.n);
    *view =
        (adcgs_scene_view){.camera = {.width = 64, .height = 64, .fx = 50.0 + camera}, .time = time, .path = film.names[film.n]};
    for (int i = 0; i < ADCGS_THUMBNAIL_CELLS; i++)
        thumbnail->cells[i] = (float)(0.3 + 0.3 * ((i * (camera + 7) * 37) % 101) / 101.0 + brighter);
    for (int i = 0; i < ADCGS_THUMBNAIL_TINTS; i++)
        thumbnail->tints[0][i] = thumbnail->tints[1][i] = 0.01f * (float)(i % 10);
    film.n++;
    return thumbnail;
}

static void begin(void)
{
    film.n = 0;
}

static adcgs_fault find(char which)
{
    adcgs_fault fault = {.cameras = 99};
    adcgs_camera_order tracks;
    adcgs_status status = ADCGS_OK;
    adcgs_scene scene = {.directory = "here", .views = {film.views}, .n_views = {film.n}};
    assert_int_equal(adcgs_camera_order_find(&tracks, film.views, film.n, &error), ADCGS_OK);
    switch (which) {
    case 'g':
        status = adcgs_fault_gaps(&fault, &scene, &error);
        break;
    case 'd':
        adcgs_fault_duplicates(&fault, NULL, film.views, &tracks, film.thumbnails);
        break;
    case 'x':
        status = adcgs_fault_copied(&fault, film.views, &tracks, film.thumbnails, &error);
        break;
    case 'l':
        status = adcgs_fault_light(&fault, NULL, film.views, &tracks, film.thumbnails, &error);
        break;
    default:
        status = adcgs_fault_clocks(&fault, film.views, &tracks, film.thumbnails, &error);
        break;
    }
    assert_int_equal(status, ADCGS_OK);
    assert_true(fault.cameras <= fault.of && isfinite(fault.from) && isfinite(fault.to) && isfinite(fault.size));
    adcgs_camera_order_clear(&tracks);
    return fault;
}

static const char all[] = "gdxlc";

static void expect_silence(const char *which)
{
    for (; *which; which++) {
        const adcgs_fault fault = find(*which);
        if (fault.cameras)
            print_error("fault '%c' at view %s, time %g, size %g\n", *which, fault.path ? fault.path : "-", fault.to, fault.size);
        assert_int_equal(fault.cameras, 0);
    }
}

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

static void what_is_not_known_says_nothing(void **state)
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
static void what_was_put_aside_is_no_gap(void **state)
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
    adcgs_trainer trainer = {.scene = &scene, .n_views = 24, .views = views, .config.retime_duplicates = 1};
    for (int pictures = 1; pictures <= 3; pictures++) {
        film_twice(pictures, 0.0, 2);
        assert_int_equal(adcgs_retime_duplicates(&trainer, film.thumbnails, &error), ADCGS_OK);
        for (int i = 0; i < 24; i++) {
            const int copies = pictures > 1 && i / 8 < pictures && (i % 8 == 4 || i % 8 == 5) ? i % 8 - 3 : 0;
            assert_true(views[i].t == (float)((i - copies) / 24.0));
        }
        assert_int_equal(trainer.duplicates.count, pictures > 1 ? 2 * pictures : 0);
    }
    trainer.config.retime_duplicates = 0;
    views[4].t = -1.0f;
    assert_int_equal(adcgs_retime_duplicates(&trainer, film.thumbnails, &error), ADCGS_OK);
    assert_true(trainer.duplicates.count == 6 && views[4].t < 0.0f);
}

/* A movement to and fro may rest where it turns. */
static void what_turns_may_rest(void **state)
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
static void doubled_pictures_of_one_that_moves(void **state)
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
static void what_all_see_is_no_copy(void **state)
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

/* ---- Light ---- */

/*
 * Cameras that each see all frames. From frame `at` until `until` the images are brighter by exp(size), or have another tint, in
 * all cells. In `off` per cent of the cells the change is twice as large. cameras: how many of three change.
 */
static void film_light(adcgs_thumbnail_light light, double size, int at, int until, int off, int cameras)
{
    begin();
    for (int i = 0; i < 3 * 16; i++) {
        adcgs_thumbnail *const thumbnail = add_view(i % 3, i / 3, 0.0);
        if (i % 3 >= cameras || i / 3 < at || i / 3 >= until)
            continue;
        for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
            if (light == ADCGS_LIGHT_BRIGHTER)
                thumbnail->cells[k] *= (float)exp(k % 100 < off ? 2.0 * size : size);
        for (int k = 0; k < ADCGS_THUMBNAIL_TINTS && light > ADCGS_LIGHT_BRIGHTER; k++)
            thumbnail->tints[light - ADCGS_LIGHT_REDDER][k] += (float)(k % 100 < off ? 2.0 * size : size);
    }
}

static void steps_of_light_are_found(void **state)
{
    (void)state;
    for (int light = 0; light < ADCGS_LIGHTS; light++)
        for (int sign = -1; sign <= 1; sign += 2) {
            film_light((adcgs_thumbnail_light)light, sign * 0.0767, 8, 99, 0, 3);
            expect_silence("l");
            for (int cameras = 1; cameras <= 3; cameras++) {
                film_light((adcgs_thumbnail_light)light, sign * 0.0773, 8, 99, 0, cameras);
                const adcgs_fault fault = find('l');
                assert_true((int)fault.cameras == cameras && fault.of == 3 && fault.count == 1 && (int)fault.light == light);
                assert_true(fault.from == 7.0 && fault.to == 8.0 && fabs(log(fault.size) - sign * 0.0773) < 1e-5);
            }
            film_light((adcgs_thumbnail_light)light, sign * 0.2, 8, 9, 0, 3); /* a flash */
            assert_int_equal(find('l').cameras, 3);
            film_light((adcgs_thumbnail_light)light, sign * 0.2, 8, 99, 49, 3); /* nearly half of the cells: larger */
            assert_int_equal(find('l').cameras, 3);
            film_light((adcgs_thumbnail_light)light, sign * 0.2, 1, 99, 0, 3); /* steps at the ends are not reported */
            expect_silence("l");
        }
}

/* The step of more than half of the cells deviates by a third to either side: the content has changed, not the light. */
static void what_moves_is_no_light(void **state)
{
    (void)state;
    for (int spread = 0; spread < 2; spread++) {
        film_light(ADCGS_LIGHT_BRIGHTER, 0.2, 8, 99, 0, 3);
        for (uint32_t i = 24; i < film.n; i++)
            for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
                film.thumbnails[i].cells[k] *= (float)exp((k % 10 < 4 ? 0.0 : k % 2 ? 0.2 : -0.2) * (spread ? 0.35 : 0.32));
        assert_int_equal(find('l').cameras, spread ? 0 : 3);
    }
}

/* Light that changes all the time, by a third of the step or more, has no steps. */
static void light_that_changes_all_the_time(void **state)
{
    (void)state;
    for (int much = 0; much < 2; much++) {
        film_light(ADCGS_LIGHT_BRIGHTER, 0.2, 8, 99, 0, 3);
        for (uint32_t i = 0; i < film.n; i++)
            for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
                film.thumbnails[i].cells[k] *= (float)exp((much ? 0.11 : 0.09) * (film.views[i].time - 8.0));
        assert_int_equal(find('l').cameras, much ? 0 : 3);
    }
}

/* An image that becomes redder and a little brighter is reported as redder. */
static void the_greatest_step_is_told(void **state)
{
    (void)state;
    film_light(ADCGS_LIGHT_REDDER, 0.3, 8, 99, 0, 3);
    for (uint32_t i = 24; i < film.n; i++)
        for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
            film.thumbnails[i].cells[k] *= (float)exp(0.1);
    assert_true(find('l').light == ADCGS_LIGHT_REDDER && find('l').cameras == 3);
}

/* ---- Correction of light ---- */

static void even(void)
{
    uint8_t behind[MOST] = {0};
    adcgs_fault fault;
    adcgs_camera_order tracks;
    assert_int_equal(adcgs_camera_order_find(&tracks, film.views, film.n, &error), ADCGS_OK);
    for (uint32_t i = 0; i < film.n; i++) /* values from before, to be overwritten */
        film.views[i].stops[i % 3] = 7.0f;
    assert_int_equal(adcgs_fault_light(&fault, behind, film.views, &tracks, film.thumbnails, &error), ADCGS_OK);
    adcgs_light_add_up(film.views, behind, &tracks, film.thumbnails);
    adcgs_camera_order_clear(&tracks);
}

/* Expects the correction of film_light(): in `cameras` cameras from `at` on; gains: the logarithms per channel. */
static void expect_even(int at, const double gains[3], int cameras)
{
    even();
    for (int i = 0; i < 3 * 16; i++)
        for (int c = 0; c < 3; c++) {
            const double expected = i / 3 >= at && i % 3 < cameras ? gains[c] / log(2.0) : 0.0;
            assert_true(fabs((double)film.views[i].stops[c] - expected) < 1e-4);
        }
}

/*
 * A brighter image is brighter in all channels. An image that is redder at the same brightness is darker in the other channels.
 */
static void steps_of_light_are_evened(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double size = sign * 0.3, all_alike[3] = {size, size, size};
        for (int cameras = 0; cameras <= 3; cameras++) {
            film_light(ADCGS_LIGHT_BRIGHTER, size, 8, 99, 0, cameras);
            expect_even(8, all_alike, cameras);
        }
        film_light(ADCGS_LIGHT_BRIGHTER, size, 8, 9, 0, 3); /* after a flash the light is as before */
        even();
        for (int i = 0; i < 3 * 16; i++)
            assert_true(fabs((double)film.views[i].stops[1] * log(2.0) - (i / 3 == 8 ? size : 0.0)) < 1e-4);
        for (int light = ADCGS_LIGHT_REDDER; light <= ADCGS_LIGHT_BLUER; light++) {
            film_light((adcgs_thumbnail_light)light, size, 8, 99, 0, 3);
            for (uint32_t i = 0; i < film.n; i++) /* of one tint, so that the gains are known */
                for (int k = 0; k < ADCGS_THUMBNAIL_TINTS; k++)
                    film.thumbnails[i].tints[0][k] = film.thumbnails[i].tints[1][k] = 0.0f;
            for (uint32_t i = 24; i < film.n; i++)
                for (int k = 0; k < ADCGS_THUMBNAIL_TINTS; k++)
                    film.thumbnails[i].tints[light - ADCGS_LIGHT_REDDER][k] = (float)size;
            const double green = log(3.0 / (2.0 + exp(size)));
            double gains[3] = {green, green, green};
            gains[light == ADCGS_LIGHT_REDDER ? 0 : 2] += size;
            expect_even(8, gains, 3);
        }
    }
}

/* A second step adds to the first. Where too few cells have a value, and for a camera of few images, there is no correction. */
static void what_is_evened_adds_up(void **state)
{
    (void)state;
    film_light(ADCGS_LIGHT_BRIGHTER, 0.3, 4, 99, 0, 3);
    for (uint32_t i = 36; i < film.n; i++)
        for (int k = 0; k < ADCGS_THUMBNAIL_CELLS; k++)
            film.thumbnails[i].cells[k] *= (float)exp(-0.5);
    even();
    for (int i = 0; i < 3 * 16; i++)
        assert_true(fabs((double)film.views[i].stops[0] * log(2.0) - (i / 3 < 4 ? 0.0 : i / 3 < 12 ? 0.3 : -0.2)) < 1e-4);
    film_light(ADCGS_LIGHT_BRIGHTER, 0.3, 8, 99, 0, 3);
    for (uint32_t i = 0; i < film.n; i++)
        for (int k = 0; k < ADCGS_THUMBNAIL_TINTS; k++)
            film.thumbnails[i].tints[0][k] = NAN;
    expect_even(8, (const double[3]){0.0, 0.0, 0.0}, 3);
}

/* ---- Clocks ---- */

/*
 * Content that jerks at the same times for all cameras. The first `of` cameras are `late` frames late; jerks: how many stand out.
 */
static void film_clocks(int cameras, int moments, int late, int of, int jerks)
{
    double jerk[MOMENTS + 32], shown[CAMERAS] = {0.0};
    random_state = 5;
    for (int i = 0; i < MOMENTS + 32; i++)
        jerk[i] = 0.001;
    for (int i = 0, at = 17; i < jerks; i++, at += 2 + (int)(3.0 * draw()))
        if (at < MOMENTS + 32)
            jerk[at] = 0.02 + 0.02 * draw();
    begin();
    for (int i = 0; i < moments; i++)
        for (int c = 0; c < cameras; c++) {
            const double step = jerk[16 + i - (c < of ? late : 0)] * (1.0 + 0.2 * c);
            shown[c] += shown[c] > 0.05 ? -step : step;
            add_view(c, i, shown[c]);
        }
}

static void clocks_that_are_off_are_found(void **state)
{
    (void)state;
    for (int late = -5; late <= 5; late++) {
        film_clocks(4, 40, late, 1, 30);
        const adcgs_fault fault = find('c');
        assert_true(fault.of == 4 && fault.cameras == (late != 0));
        if (late)
            assert_true((int)fault.count == abs(late) && fault.size == late && !strcmp(fault.path, "0"));
    }
    film_clocks(3, 40, 2, 1, 30);
    assert_int_equal(find('c').cameras, 1);
    film_clocks(2, 40, 2, 1, 30); /* with two cameras, either may be late */
    expect_silence("c");
    film_clocks(4, 40, 2, 2, 30); /* the same with two against two */
    expect_silence("c");
}

static void too_little_tells_no_clock(void **state)
{
    (void)state;
    film_clocks(4, 12, 0, 0, 30); /* eleven changes are too few */
    assert_int_equal(find('c').of, 0);
    film_clocks(4, 13, 0, 0, 30);
    assert_int_equal(find('c').of, 4);
    film_clocks(4, 40, 2, 1, 2); /* two events are too few: one camera may only see them later */
    expect_silence("c");
    film_clocks(4, 40, 2, 1, 6);
    assert_int_equal(find('c').cameras, 1);
}

/* Periodic motion fits several time offsets. */
static void what_repeats_tells_no_clock(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < 40; i++)
        for (int c = 0; c < 4; c++)
            add_view(c, i, (i + (c == 0)) % 4 < 2 ? 0.0 : 0.05);
    expect_silence("c");
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

static void what_moves_as_it_likes_has_no_fault(void **state)
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
static void what_is_masked_does_not_count(void **state)
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
        cmocka_unit_test(what_is_not_known_says_nothing),
        cmocka_unit_test(gaps_are_found),
        cmocka_unit_test(gaps_of_all_are_the_scenes),
        cmocka_unit_test(what_was_put_aside_is_no_gap),
        cmocka_unit_test(doubled_pictures_are_found),
        cmocka_unit_test(doubled_pictures_are_of_the_time_before),
        cmocka_unit_test(what_turns_may_rest),
        cmocka_unit_test(doubled_pictures_of_one_that_moves),
        cmocka_unit_test(pictures_of_others_are_found),
        cmocka_unit_test(what_all_see_is_no_copy),
        cmocka_unit_test(steps_of_light_are_found),
        cmocka_unit_test(what_moves_is_no_light),
        cmocka_unit_test(steps_of_light_are_evened),
        cmocka_unit_test(what_is_evened_adds_up),
        cmocka_unit_test(light_that_changes_all_the_time),
        cmocka_unit_test(the_greatest_step_is_told),
        cmocka_unit_test(clocks_that_are_off_are_found),
        cmocka_unit_test(too_little_tells_no_clock),
        cmocka_unit_test(what_repeats_tells_no_clock),
        cmocka_unit_test(what_moves_as_it_likes_has_no_fault),
        cmocka_unit_test(what_is_masked_does_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
