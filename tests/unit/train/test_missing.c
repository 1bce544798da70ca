/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Missing light: lamps in the dark that a model does not have, seen by three cameras or by two of them. */
#include "outside_files.h"

#include "media/image/image.h"
#include "scene/scene.h"
#include "train/density/residual_densify.h"
#include "train/settings.h"
#include "train/train_views.h"
#include "train/trainer.h"

#include <math.h>

enum { CAMERAS = 3, SIDE = 128, FOCAL = 100, ACROSS = 3, DOWN = 4, LAMPS = ACROSS * DOWN, POINTS = 32 };
#define RADIUS 0.02 /* of a lamp */

static adcgs_scene_view views[CAMERAS];
static double dark[POINTS][3];
static uint8_t black[POINTS][3];
static adcgs_scene scene = {.views = {views},
                            .n_views = {CAMERAS},
                            .n_times = 1,
                            .rate = {1, 1},
                            .points = {.n = POINTS, .coloured = 1}};

/** Lamps as on a bulging wall, not quite in rows. All cameras see those in the middle; only two see those on the left. */
static void lamp_at(int cluster, int i, double x[3])
{
    const int a = i % ACROSS, b = i / ACROSS;
    x[0] = (cluster ? -1.7 : -0.3) + 0.24 * a + 0.04 * (b % 2);
    x[1] = -0.5 + 0.29 * b + 0.05 * (a % 2);
    x[2] = 3 - 0.2 * (a - 1) * (a - 1) + 0.05 * b;
}

static double light(const adcgs_camera *c, double px, double py)
{
    for (int k = 0; k < 2 * LAMPS; k++) {
        double x[3];
        lamp_at(k / LAMPS, k % LAMPS, x);
        const double u = c->fx * (x[0] - c->cam_to_world[3]) / x[2] + c->cx - px, v = c->fy * x[1] / x[2] + c->cy - py;
        if (hypot(u, v) < RADIUS * FOCAL / x[2] + 0.5)
            return 1;
    }
    return 0;
}

static int put_scene(void **state)
{
    if (make_folder(state) != 0)
        return -1;
    for (int i = 0; i < CAMERAS; i++) {
        adcgs_scene_view *v = &views[i];
        char name[16];
        adcgs_image image;
        v->camera = (adcgs_camera){.width = SIDE,
                                   .height = SIDE,
                                   .fx = FOCAL,
                                   .fy = FOCAL,
                                   .cx = SIDE / 2,
                                   .cy = SIDE / 2,
                                   .near_plane = 0.01,
                                   .cam_to_world = {1, 0, 0, i - 1, 0, 1, 0, 0, 0, 0, 1, 0}};
        snprintf(name, sizeof name, "%d.ppm", i);
        v->path = strdup(in(name));
        assert_int_equal(adcgs_image_alloc(&image, SIDE, SIDE, 3, name, &error), ADCGS_OK);
        for (int k = 0; k < 3 * SIDE * SIDE; k++)
            image.data[k] = (float)light(&v->camera, k / 3 % SIDE + 0.5, k / 3 / SIDE + 0.5);
        assert_int_equal(adcgs_image_write(&image, v->path, 0, &error), ADCGS_OK);
        adcgs_image_free(&image);
    }
    for (int i = 0; i < POINTS; i++) /* a dark ground */
        memcpy(dark[i], (const double[]){0.25 * (i % 8 - 4), 1.2, 2 + 0.3 * (double)(i / 8)}, sizeof dark[i]);
    scene.points.position = dark;
    scene.points.colour = black;
    return 0;
}

static int remove_scene(void **state)
{
    for (int i = 0; i < CAMERAS; i++)
        free(views[i].path);
    return remove_folder(state);
}

/** Lamps are found in their places, by three cameras or by two. Nothing is found nearer to the cameras. */
static void lamps_are_found_where_they_are(void **state)
{
    enum { MOST = 512 };
    static adcgs_residual places[MOST];
    adcgs_train_config config;
    adcgs_trainer *t;
    uint32_t n, beside = 0, found[2] = {0, 0};
    assert_int_equal(adcgs_train_preset(&config, "draft", &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_create(&t, &scene, &config, adcgs_cpu_best(), NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_load_views(t, 1, &error), ADCGS_OK);
    adcgs_curriculum_grow(&t->curriculum, 1, t->f);
    assert_int_equal(adcgs_residual_find(t, places, MOST, &n, &error), ADCGS_OK);
    for (int k = 0; k < 2 * LAMPS; k++) {
        double x[3], least = INFINITY;
        lamp_at(k / LAMPS, k % LAMPS, x);
        for (uint32_t i = 0; i < n; i++) {
            double d = 0;
            for (int a = 0; a < 3; a++)
                d += pow(t->origin[a] + t->scale * (double)places[i].x[a] - x[a], 2);
            least = fmin(least, sqrt(d));
        }
        found[k / LAMPS] += least < 0.12;
    }
    for (uint32_t i = 0; i < n; i++)
        beside += fabs(t->origin[2] + t->scale * (double)places[i].x[2] - 3) > 0.4;
    print_message("%u places, %u of them off; found of %d lamps: %u by three cameras, %u by two\n", n, beside, LAMPS, found[0],
                  found[1]);
    assert_int_equal(found[0], LAMPS);
    assert_int_equal(found[1], LAMPS);
    assert_true(50 * beside <= n);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lamps_are_found_where_they_are)};
    return cmocka_run_group_tests(tests, put_scene, remove_scene);
}
