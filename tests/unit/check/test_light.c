/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Faults of footage that appear in brightness: steps of light and their correction, clocks of cameras. */
#include "footage_views.h"

#include "check/faults.h"
#include "check/light.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

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
static void test_moving_content_is_no_light(void **state)
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
static void test_corrections_add_up(void **state)
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

static void test_few_changes_report_no_clock(void **state)
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
static void test_periodic_motion_reports_no_clock(void **state)
{
    (void)state;
    begin();
    for (int i = 0; i < 40; i++)
        for (int c = 0; c < 4; c++)
            add_view(c, i, (i + (c == 0)) % 4 < 2 ? 0.0 : 0.05);
    expect_silence("c");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_of_light_are_found),
        cmocka_unit_test(test_moving_content_is_no_light),
        cmocka_unit_test(steps_of_light_are_evened),
        cmocka_unit_test(test_corrections_add_up),
        cmocka_unit_test(light_that_changes_all_the_time),
        cmocka_unit_test(the_greatest_step_is_told),
        cmocka_unit_test(clocks_that_are_off_are_found),
        cmocka_unit_test(test_few_changes_report_no_clock),
        cmocka_unit_test(test_periodic_motion_reports_no_clock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
