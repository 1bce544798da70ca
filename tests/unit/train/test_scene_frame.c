/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene's frame of reference is centred on the place at which the cameras look, for any directions. */
#include "outside_files.h"

#include "train/scene_frame.h"

#include <math.h>

enum { VIEWS = 24, POINTS = 400 };

static adcgs_scene_view views[VIEWS];
static adcgs_scene scene;

/** A camera at c that looks along d (of any length, not along y). */
static void place(adcgs_camera *camera, const double c[3], const double d[3])
{
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), z[3] = {d[0] / length, d[1] / length, d[2] / length};
    const double flat = sqrt(z[0] * z[0] + z[2] * z[2]), x[3] = {z[2] / flat, 0, -z[0] / flat};
    const double y[3] = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]};
    *camera = (adcgs_camera){.width = 100, .height = 100, .fx = 80, .fy = 80, .cx = 50, .cy = 50, .near_plane = 0.01};
    for (int a = 0; a < 3; a++) {
        double *row = camera->cam_to_world + 4 * a;
        row[0] = x[a];
        row[1] = y[a];
        row[2] = z[a];
        row[3] = c[a];
    }
}

/** Cameras along x from -1 to 1 that look along z, each turned outwards in proportion to its x. */
static void sweep(double outwards)
{
    for (int i = 0; i < VIEWS; i++) {
        const double x = -1 + 2 * i / (VIEWS - 1.0);
        place(&views[i].camera, (const double[]){x, 0, 0}, (const double[]){outwards * x, 0, 1});
    }
    scene = (adcgs_scene){.views = {views}, .n_views = {VIEWS}, .n_times = 1};
}

/** Points on a wall at z, wide enough for all cameras. */
static void put_wall(double z)
{
    scene.points.n = POINTS;
    scene.points.position = calloc(POINTS, sizeof *scene.points.position);
    assert_non_null(scene.points.position);
    for (int i = 0; i < POINTS; i++) {
        scene.points.position[i][0] = -8 + 16 * (i % 20) / 19.0f;
        scene.points.position[i][1] = -8 + 16 * (i / 20) / 19.0f;
        scene.points.position[i][2] = (float)z;
    }
}

static void find(double origin[3], double *scale)
{
    if (adcgs_scene_frame(&scene, origin, scale, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    free(scene.points.position);
    scene.points.position = NULL;
}

/** Axes that meet behind the cameras, far from the visible points, or far beyond them: the focus is on the points. */
static void focus_is_on_what_is_seen(void **state)
{
    static const double outwards[] = {0.02, 0.2, -0.02, 0};
    for (size_t i = 0; i < ADCGS_COUNTOF(outwards); i++) {
        double origin[3], scale;
        sweep(outwards[i]);
        put_wall(5);
        find(origin, &scale);
        assert_float_equal(origin[0], 0, 0.5);
        assert_float_equal(origin[1], 0, 0.5);
        assert_float_equal(origin[2], 5, 0.5);
        assert_float_equal(scale, 5, 0.5);
    }
}

/** Axes that meet among the points determine the focus, to the last bit, for any points. */
static void inward_axes_are_believed(void **state)
{
    double with[3], without[3], scale[2];
    sweep(-0.25); /* they meet at z = 4 */
    find(without, &scale[0]);
    put_wall(5);
    find(with, &scale[1]);
    assert_memory_equal(with, without, sizeof with);
    assert_memory_equal(&scale[0], &scale[1], sizeof scale[0]);
    assert_float_equal(with[2], 4, 1e-9);
}

/** Without points, the focus is still in front of every camera. */
static void focus_is_in_front_without_points(void **state)
{
    double origin[3], scale;
    sweep(0.2);
    find(origin, &scale);
    for (int i = 0; i < VIEWS; i++) {
        const double *m = views[i].camera.cam_to_world;
        assert_true((origin[0] - m[3]) * m[2] + (origin[1] - m[7]) * m[6] + (origin[2] - m[11]) * m[10] > 0);
    }
}

/** Cameras in a ring that look outwards: their middle is the focus, and the visible points are not far beyond the unit. */
static void outward_rings_have_units_of_what_is_seen(void **state)
{
    double origin[3], scale;
    sweep(0);
    for (int i = 0; i < VIEWS; i++) {
        const double angle = 6.283185307179586 * i / VIEWS, d[3] = {cos(angle), 0, sin(angle)};
        place(&views[i].camera, (const double[]){0.1 * d[0], 0, 0.1 * d[2]}, d);
    }
    scene.points.n = POINTS;
    scene.points.position = calloc(POINTS, sizeof *scene.points.position);
    assert_non_null(scene.points.position);
    for (int i = 0; i < POINTS; i++) {
        const double angle = 6.283185307179586 * i / POINTS;
        scene.points.position[i][0] = (float)(4 * cos(angle));
        scene.points.position[i][1] = (float)(i % 7 - 3) / 3;
        scene.points.position[i][2] = (float)(4 * sin(angle));
    }
    find(origin, &scale);
    for (int a = 0; a < 3; a++)
        assert_float_equal(origin[a], 0, 0.5);
    assert_true(scale > 1 && scale < 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(focus_is_on_what_is_seen),
        cmocka_unit_test(inward_axes_are_believed),
        cmocka_unit_test(focus_is_in_front_without_points),
        cmocka_unit_test(outward_rings_have_units_of_what_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
