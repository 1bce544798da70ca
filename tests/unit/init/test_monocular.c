/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Static and moving points of a monocular sequence, generated with known truth. */
#include "outside_files.h"

#include "init/stereo.h"
#include "scene/layouts/open.h"
#include "synthetic/scenes.h"
#include "train/scene_frame.h"

#include <math.h>

#define SIDE 128
/* The box of film-cross80: its centre at time 0, and the distance to its place at time 1, in units of the data set. */
#define CROSSES (0.80 * 4.2 * 2.0 / 2.5)
static const double begin[3] = {-0.5 * CROSSES, -0.10, 0.26};

static adcgs_scene *scene;
static adcgs_stereo found;
static adcgs_stereo_options options = {.still = 3000, .moving = 2000};
static adcgs_pool *pool;

static int setup(void **state)
{
    const adcgs_scenes_options film = {.name = "film-cross80", .width = SIDE, .height = SIDE, .format = "ppm"};
    return make_folder(state) || adcgs_pool_create(&pool, 2, &error) != ADCGS_OK ||
           adcgs_scenes_write(folder, &film, pool, NULL, NULL, &error) != ADCGS_OK ||
           adcgs_scene_open(&scene, folder, NULL, &error) != ADCGS_OK ||
           adcgs_scene_frame(scene, options.origin, &options.scale, &error) != ADCGS_OK ||
           adcgs_stereo_find(&found, scene, &options, pool, &error) != ADCGS_OK;
}

static int teardown(void **state)
{
    adcgs_stereo_clear(&found);
    adcgs_scene_free(&scene);
    adcgs_pool_free(&pool);
    return remove_folder(state);
}

static void to_world(const double x[3], double world[3])
{
    for (int a = 0; a < 3; a++)
        world[a] = options.origin[a] + options.scale * x[a];
}

static int applies(void)
{
    int yes = -1;
    assert_int_equal(adcgs_stereo_applies(scene, &yes, &error), ADCGS_OK);
    return yes;
}

static void a_film_is_matched(void **state)
{
    adcgs_scene_view *const views = scene->views[ADCGS_SPLIT_TRAIN];
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double times[200];
    (void)state;
    assert_true(applies());
    assert_true(n <= 200 && n % 37);
    for (uint32_t i = 0; i < n; i++)
        times[i] = views[i].time;
    for (uint32_t i = 0; i < n; i++) /* images in a mixed order are no sequence */
        views[i].time = times[i * 37 % n];
    assert_false(applies());
    for (uint32_t i = 0; i < n; i++)
        views[i].time = times[i];
}

/** The table's top is at z = 0 and covers most of the image. */
static void test_places_of_static_points(void **state)
{
    uint32_t on_table = 0, below = 0;
    (void)state;
    assert_in_range(found.n_still, 1500, 3000);
    for (uint32_t i = 0; i < found.n_still; i++) {
        double x[3];
        to_world(found.still[i].x, x);
        on_table += fabs(x[2]) < 0.06;
        below += x[2] < -0.15 && hypot(x[0], x[1]) < 2;
        assert_false(found.still[i].moves);
    }
    assert_true(on_table > found.n_still / 4);
    assert_true(below < found.n_still / 20);
}

/** In most frames the moving points are about the box, and move as it does. */
static void test_places_of_moving_points(void **state)
{
    uint32_t good = 0, first = 0, last;
    double speed = 0;
    (void)state;
    assert_true(found.n_frames >= 20 && found.n_moving > 1000);
    for (uint32_t m = 0; m < found.n_frames; m++, first = last) {
        double sum[3] = {0, 0, 0}, x[3], off = 0;
        uint32_t n = 0;
        for (last = first; last < found.n_moving && found.moving[last].t <= found.frame_time[m]; last++) {
            to_world(found.moving[last].x, x);
            for (int a = 0; a < 3; a++)
                sum[a] += x[a];
            speed += found.moving[last].velocity[0] * options.scale;
            n++;
        }
        for (int a = 0; a < 3; a++)
            off = fmax(off, fabs(sum[a] / fmax(n, 1) - begin[a] - (a ? 0 : CROSSES * (double)found.frame_time[m])));
        good += n >= 100 && off < 0.4;
    }
    assert_int_equal(first, found.n_moving);
    assert_true(good >= found.n_frames * 3 / 4);
    assert_true(fabs(speed / found.n_moving - CROSSES) < 0.4 * CROSSES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_film_is_matched),
        cmocka_unit_test(test_places_of_static_points),
        cmocka_unit_test(test_places_of_moving_points),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
