/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene generator: its arithmetic, its independence of threads, and the properties that its table promises. */
#include "synthetic/scene_views.h"
#include "synthetic/scenes.h"
#include "synthetic/sine.h"
#include "synthetic/table.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

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

/* A camera that looks at the target from the front, for images of size x size. */
static adcgs_trace_camera front(int size)
{
    adcgs_trace_camera camera = {.focal = 0.5 * ADCGS_SCENES_FOCAL * size};
    const double eye[3] = {0.0, -3.6, 2.5}, target[3] = {0.0, 0.0, 0.35};
    adcgs_trace_look(&camera, eye, target);
    return camera;
}

/* Coverage of that camera's image by the scene's moving objects. */
static void cover(const adcgs_scenes_entry *scene, double time, int size, int samples, float *out)
{
    const adcgs_trace_camera camera = front(size);
    assert_int_equal(adcgs_trace_cover(scene->objects, scene->n_objects, scene->moving, &camera, time, size, size, samples, NULL,
                                       out, NULL),
                     ADCGS_OK);
}

/* Image of cross20 from the same place, one ray per pixel, with its box in one grey and without a pattern. */
static void paint(float grey, float *rgb)
{
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find("cross20");
    adcgs_trace_object objects[8];
    memcpy(objects, scene->objects, (size_t)scene->n_objects * sizeof objects[0]);
    adcgs_trace_object *const mover = &objects[scene->n_objects - 1];
    mover->texture = ADCGS_TEXTURE_PLAIN;
    mover->detail = 0.0;
    for (int c = 0; c < 3; c++)
        mover->colour[0][c] = (double)grey;
    const adcgs_trace_camera camera = front(SIZE);
    assert_int_equal(adcgs_trace_render(objects, scene->n_objects, &camera, 0.4, SIZE, SIZE, 1, NULL, rgb, NULL), ADCGS_OK);
}

/* An object covers exactly the pixels where its colour is visible. */
static void covered_is_what_is_seen(void **state)
{
    static float black[FLOATS], white[FLOATS], mask[FLOATS];
    const adcgs_trace_camera camera = front(1);
    int n = 0;
    (void)state;
    paint(0.0f, black);
    paint(1.0f, white);
    cover(adcgs_scenes_entry_find("cross20"), 0.4, SIZE, 1, mask);
    for (int i = 0; i < SIZE * SIZE; i++) {
        assert_true(mask[i] == (float)(black[3 * i] != white[3 * i]));
        n += mask[i] > 0.0f;
    }
    assert_true(n > 20 && n < SIZE * SIZE / 8);
    assert_int_equal(adcgs_trace_cover(NULL, 0, 1, &camera, 0.0, 1, 1, 99, NULL, mask, NULL), ADCGS_ERR_USAGE);
}

/* The samples of a pixel are the pixels of a finer image. A pixel is covered if at least half of them are. */
static void half_of_the_samples_cover(void **state)
{
    static float mask[FLOATS], fine[9 * FLOATS];
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find("cross20");
    (void)state;
    for (int samples = 2; samples <= 3; samples++) {
        int halves = 0;
        cover(scene, 0.4, SIZE, samples, mask);
        cover(scene, 0.4, SIZE * samples, 1, fine);
        for (int i = 0; i < SIZE * SIZE; i++) {
            const float *const first = fine + i / SIZE * samples * SIZE * samples + i % SIZE * samples;
            int sum = 0;
            for (int k = 0; k < samples * samples; k++)
                sum += first[k / samples * SIZE * samples + k % samples] > 0.0f;
            assert_true(mask[i] == (float)(2 * sum >= samples * samples));
            halves += 2 * sum == samples * samples;
        }
        assert_true(samples == 3 || halves);
    }
}

enum { LARGE = 120 };

/* Mean column of the moving objects, as a share of the width, and their number of pixels. */
static double middle(const char *name, double time, int *n)
{
    static float mask[LARGE * LARGE];
    double sum = 0.0;
    cover(adcgs_scenes_entry_find(name), time, LARGE, 2, mask);
    *n = 0;
    for (int i = 0; i < LARGE * LARGE; i++)
        if (mask[i] > 0.0f) {
            sum += i % LARGE + 0.5;
            ++*n;
        }
    return *n ? sum / *n / LARGE : 0.5;
}

/* Objects cross as far as the names say, and are never hidden for long. */
static void crossings_are_as_long_as_they_say(void **state)
{
    static const int percent[] = {5, 20, 80};
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(percent); i++) {
        char name[16];
        int n;
        snprintf(name, sizeof name, "cross%d", percent[i]);
        const double share = percent[i] / 100.0, from = middle(name, 0.0, &n);
        for (int t = 1; t <= 8; t++) {
            const double gone = middle(name, t / 8.0, &n) - from;
            assert_true(fabs(gone - share * t / 8) < 0.1 * share);
            assert_true(n > 250);
        }
    }
}

static double difference(const char *name, double time, double other)
{
    static float a[FLOATS], b[FLOATS];
    double sum = 0.0;
    render(adcgs_scenes_entry_find(name), time, NULL, a);
    render(adcgs_scenes_entry_find(name), other, NULL, b);
    for (int i = 0; i < FLOATS; i++)
        sum += fabs((double)a[i] - b[i]) / FLOATS;
    return sum;
}

/* After a whole turn the image is as before. In between, no part of a turn looks like another. */
static void boxes_turn_as_often_as_they_say(void **state)
{
    (void)state;
    for (int turns = 1; turns <= 3; turns += 2) {
        const char *const name = turns == 1 ? "turn1" : "turn3";
        assert_true(difference(name, 0.0, 1.0 / turns) < 1e-6 && difference(name, 0.0, 1.0) < 1e-6);
        for (int part = 1; part < 12; part++)
            assert_true(difference(name, 0.0, part / 12.0 / turns) > 0.004);
    }
}

/* Before an object appears it casts no shadow either: without the object the image is the same, to the bit. */
static void test_appearing_object_is_absent_before(void **state)
{
    static float before[FLOATS], without[FLOATS], after[FLOATS];
    const adcgs_scenes_entry *const scene = adcgs_scenes_entry_find("appear");
    adcgs_scenes_entry less = *scene;
    int n;
    (void)state;
    less.n_objects--;
    render(scene, 11.0 / 23.0, NULL, before);
    render(&less, 11.0 / 23.0, NULL, without);
    render(scene, 12.0 / 23.0, NULL, after);
    assert_memory_equal(before, without, sizeof before);
    assert_memory_not_equal(before, after, sizeof before);
    middle("appear", 0.499, &n);
    assert_int_equal(n, 0);
    middle("appear", 0.5, &n);
    assert_true(n > 250);
}

/* Number of columns without moving objects, between the first and the last column with some. */
static int gap(double time)
{
    static float mask[LARGE * LARGE];
    int first = LARGE, last = 0, filled = 0;
    cover(adcgs_scenes_entry_find("split"), time, LARGE, 2, mask);
    for (int x = 0; x < LARGE; x++) {
        int any = 0;
        for (int y = 0; y < LARGE; y++)
            any |= mask[y * LARGE + x] > 0.0f;
        filled += any;
        first = any ? ADCGS_MIN(first, x) : first;
        last = any ? x : last;
    }
    return last - first + 1 - filled;
}

static void halves_come_apart(void **state)
{
    (void)state;
    assert_int_equal(gap(0.0), 0);
    assert_in_range(gap(0.5), 12, 26);
    assert_in_range(gap(1.0), 30, 50);
}

/* A ball that is stretched along x and compressed along z at a quarter of its period, and back in shape at half. */
static void test_soft_object_changes_its_shape(void **state)
{
    static float mask[3][LARGE * LARGE];
    int width[3] = {0, 0, 0}, height[3] = {0, 0, 0};
    (void)state;
    for (int k = 0; k < 3; k++) {
        cover(adcgs_scenes_entry_find("soft"), 0.25 * k, LARGE, 2, mask[k]);
        for (int i = 0; i < LARGE; i++) {
            int across = 0, down = 0;
            for (int j = 0; j < LARGE; j++) {
                across += mask[k][i * LARGE + j] > 0.0f;
                down += mask[k][j * LARGE + i] > 0.0f;
            }
            width[k] = ADCGS_MAX(width[k], across);
            height[k] = ADCGS_MAX(height[k], down);
        }
    }
    assert_in_range(width[0] - height[0] + 2, 0, 4);
    assert_in_range(100 * width[1] / width[0], 120, 140);
    assert_true(height[1] < height[0] - 2);
    assert_memory_equal(mask[0], mask[2], sizeof mask[0]);
}

/* Impossible options are errors. Valid ones are tested by tests/cli/test_enc.sh. */
static void wrong_counts_are_refused(void **state)
{
    static const struct {
        adcgs_scenes_options options;
        const char *text;
    } wrong[] = {{{.name = "tiny", .cameras = 5}, "multiple"},
                 {{.name = "tiny", .noise = 65.0}, "noise of 65"},
                 {{.name = "film-turn1", .cameras = 2}, "one camera"},
                 {{.name = "tiny", .frames = -1}, "-1 frames"}};
    adcgs_error error;
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(wrong); i++) {
        assert_int_equal(adcgs_scenes_write("/nowhere", &wrong[i].options, NULL, NULL, NULL, &error), ADCGS_ERR_USAGE);
        assert_non_null(strstr(error.text, wrong[i].text));
    }
}

static void table_is_sound(void **state)
{
    (void)state;
    for (int i = 0; adcgs_scenes_name(i); i++) {
        const adcgs_scenes_entry *const scene = adcgs_scenes_entry_at(i);
        assert_ptr_equal(adcgs_scenes_entry_find(scene->name), scene);
        int images = 0;
        for (int split = 0; split < ADCGS_SPLITS; split++)
            images += adcgs_scenes_split_size(scene, split);
        assert_int_equal(images, scene->cameras / scene->turns * scene->times + scene->n_val + scene->n_test);
        assert_true(scene->n_objects < 32 && scene->moving >> scene->n_objects == 0);
        assert_true((scene->path == ADCGS_PATH_HAND) == (scene->swings > 0) && scene->cameras * scene->times > 1);
        assert_true(scene->times > 1 || !scene->moving);
        for (int k = 0; k < scene->n_objects; k++)
            assert_true(scene->objects[k].from == 0.0 || scene->moving >> k & 1); /* a static object is always present */
    }
    assert_null(adcgs_scenes_entry_find("no such scene"));
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
    options.format = "ppm";
    static const double bad[] = {0.0009, 10.1, -1.0, (double)NAN};
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        options.motion = bad[i];
        assert_int_equal(adcgs_scenes_write("/nonexistent/folder", &options, NULL, NULL, NULL, &error), ADCGS_ERR_USAGE);
        assert_non_null(strstr(error.text, "expected 0.001..10"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_is_accurate),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(pictures_have_content),
        cmocka_unit_test(table_is_sound),
        cmocka_unit_test(test_soft_object_changes_its_shape),
        cmocka_unit_test(wrong_counts_are_refused),
        cmocka_unit_test(covered_is_what_is_seen),
        cmocka_unit_test(half_of_the_samples_cover),
        cmocka_unit_test(crossings_are_as_long_as_they_say),
        cmocka_unit_test(boxes_turn_as_often_as_they_say),
        cmocka_unit_test(test_appearing_object_is_absent_before),
        cmocka_unit_test(halves_come_apart),
        cmocka_unit_test(writing_fails_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
