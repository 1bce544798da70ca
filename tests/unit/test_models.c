/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Models of COLMAP as other people make them: far from the origin, without second lines, several of them. */
#include "layout_files.h"

#include "layouts/open.h"
#include "train/settings.h"
#include "train/start_points.h"

#define CAMERA "7 PINHOLE 24 16 20 20 12 8\n"

static adcgs_scene *scene;

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static int clean(void **state)
{
    adcgs_scene_free(&scene);
    return remove_folder(state) || mkdir(folder, 0777);
}

static void put_images(int n, const char *place, const char *names)
{
    put_folder(place);
    for (int i = 0; i < n; i++) {
        char path[160], name[64];
        snprintf(name, sizeof name, names, i);
        snprintf(path, sizeof path, "%s/%s", place, name);
        put_picture(path, i, RIG_WIDTH, RIG_HEIGHT);
    }
}

/* ---- Far from the origin ---- */

static const double earth[3] = {4358066.25, 506610.5, 4614944.0}; /* metres from its centre */

/** The rig's model at another place of the world. */
static void put_model_at(const double place[3], int n)
{
    char *text = malloc(65536);
    size_t at = 0;
    assert_non_null(text);
    put_folder("sparse");
    put_text("sparse/cameras.txt", CAMERA);
    for (int i = 0; i < n; i++) {
        double pose[12], q[4], t[3];
        rig_pose(i, pose);
        for (int a = 0; a < 3; a++)
            pose[4 * a + 3] += place[a];
        rig_quaternion(pose, q, t);
        at += (size_t)sprintf(text + at, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 7 %d.ppm\n\n", i + 1, q[0], q[1], q[2], q[3],
                              t[0], t[1], t[2], i);
    }
    put_text("sparse/images.txt", text);
    at = 0;
    for (int i = 0; i < RIG_POINTS; i++) {
        double x[3];
        rig_point(i, x);
        at += (size_t)sprintf(text + at, "%d %.17g %.17g %.17g 9 9 9 0.5\n", i, x[0] + place[0], x[1] + place[1], x[2] + place[2]);
    }
    put_text("sparse/points3D.txt", text);
    free(text);
}

/** Points of the start, in the units of the scene that is open. */
static void start(adcgs_start_points *points)
{
    adcgs_train_config config;
    adcgs_stereo none = {.n_still = 0};
    expect_good(adcgs_train_preset(&config, "draft", &error));
    config.start_anchors = 200;
    expect_good(adcgs_start_points_find(points, scene, &config, &none, &error));
}

/** Cameras and points keep their places to each other, to a tenth of a millimetre, wherever they are: from files to the start. */
static void test_far(void **state)
{
    adcgs_start_points near, far;
    put_images(9, "images", "%d.ppm");
    put_model_at((const double[3]){0.0, 0.0, 0.0}, 9);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    assert_int_equal(scene->points.n, RIG_POINTS);
    start(&near);
    adcgs_scene_free(&scene);
    put_model_at(earth, 9);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    for (int i = 0; i < RIG_POINTS; i++) {
        double x[3];
        rig_point(i, x);
        for (int a = 0; a < 3; a++)
            assert_true(fabs(scene->points.position[i][a] - earth[a] - x[a]) < 1e-8);
    }
    start(&far);
    assert_true(near.n == far.n && near.n >= RIG_POINTS);
    for (int i = 0; i < RIG_POINTS; i++)
        for (int a = 0; a < 3; a++)
            assert_true(fabs(near.x[i][a] - far.x[i][a]) < 1e-5);
    adcgs_start_points_clear(&near);
    adcgs_start_points_clear(&far);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_far, clean),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
