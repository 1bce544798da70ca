/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene generator: its arithmetic, its independence of threads, and what its table promises. */
#include "scenes/scenes.h"
#include "scenes/sine.h"
#include "scenes/table.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { SIZE = 40, FLOATS = SIZE * SIZE * 3 };

static void sine_is_accurate(void **state)
{
    (void)state;
    for (int i = -4000; i <= 4000; i++) {
        const double turns = i / 1000.0, radians = 6.28318530717958647692 * turns;
        assert_true(fabs(adcgs_trace_sin(turns) - sin(radians)) < 1e-11);
        assert_true(fabs(adcgs_trace_cos(turns) - cos(radians)) < 1e-11);
    }
}

static void render(const adcgs_scenes_entry *scene, double time, adcgs_pool *pool, float *rgb)
{
    adcgs_trace_camera camera = {.focal = 1.25 * SIZE};
    const double eye[3] = {1.5, -3.8, 1.6};
    adcgs_trace_look(&camera, eye, scene->target);
    assert_int_equal(adcgs_trace_render(scene->objects, scene->n_objects, &camera, time, SIZE, SIZE, 3, pool, rgb, NULL),
                     ADCGS_OK);
}

static void threads_do_not_matter(void **state)
{
    static float one[FLOATS], three[FLOATS];
    adcgs_pool *pool = NULL;
    (void)state;
    assert_int_equal(adcgs_pool_create(&pool, 3, NULL), ADCGS_OK);
    render(adcgs_scenes_entry_find("demo"), 0.35, NULL, one);
    render(adcgs_scenes_entry_find("demo"), 0.35, pool, three);
    assert_memory_equal(one, three, sizeof one);
    adcgs_pool_free(&pool);
}

static void pictures_have_content(void **state)
{
    static float early[FLOATS], late[FLOATS];
    double mean = 0.0, change = 0.0, spread = 0.0;
    (void)state;
    render(adcgs_scenes_entry_find("demo"), 0.0, NULL, early);
    render(adcgs_scenes_entry_find("demo"), 1.0, NULL, late);
    for (int i = 0; i < FLOATS; i++) {
        assert_true(early[i] >= 0.0f && early[i] <= 1.0f);
        mean += early[i] / FLOATS;
    }
    for (int i = 0; i < FLOATS; i++) {
        spread += (early[i] - mean) * (early[i] - mean) / FLOATS;
        change += fabs((double)late[i] - early[i]) / FLOATS;
    }
    assert_true(mean > 0.3 && mean < 0.7);
    assert_true(spread > 0.01);
    assert_true(change > 0.005 && change < 0.2);
}

static void table_is_sound(void **state)
{
    (void)state;
    for (int i = 0; adcgs_scenes_name(i); i++) {
        const adcgs_scenes_entry *const scene = adcgs_scenes_entry_at(i);
        assert_ptr_equal(adcgs_scenes_entry_find(scene->name), scene);
        assert_int_equal(adcgs_scenes_count(scene->name),
                         scene->cameras / scene->turns * scene->times + scene->n_val + scene->n_test);
        assert_true(scene->n_objects < 32 && scene->moving >> scene->n_objects == 0);
        assert_true(scene->cameras > 1 && scene->times > 1);
    }
    assert_null(adcgs_scenes_entry_find("no such scene"));
    assert_int_equal(adcgs_scenes_count("no such scene"), 0);
}

static void writing_fails_in_one_line(void **state)
{
    adcgs_error error;
    adcgs_scenes_options options = {.name = "nothing"};
    (void)state;
    assert_int_equal(adcgs_scenes_write("/nonexistent/folder", &options, NULL, NULL, NULL, &error), ADCGS_ERR_USAGE);
    options.name = "tiny";
    assert_int_equal(adcgs_scenes_write("/nonexistent/folder", &options, NULL, NULL, NULL, &error), ADCGS_ERR_IO);
    assert_non_null(strstr(error.text, "/nonexistent/folder"));
    options.format = "bmp";
    assert_int_equal(adcgs_scenes_write("/nonexistent/folder", &options, NULL, NULL, NULL, &error), ADCGS_ERR_USAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_is_accurate),      cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(pictures_have_content), cmocka_unit_test(table_is_sound),
        cmocka_unit_test(writing_fails_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
