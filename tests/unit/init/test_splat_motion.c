/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The motion that is read from splats over time: static splats, rigid bodies, lifetimes, with identity and without. */
#include "outside_files.h"

#include "init/splats/splat_motion.h"
#include "scene/layouts/open.h"

#include <math.h>

static adcgs_scene *scene;

static void open_scene(const char *name, uint32_t frames)
{
    const adcgs_scene_options options = {.splat_frames = frames, .rate = {24, 1}};
    const char *const path = real_data(name);
    if (adcgs_scene_open(&scene, path, &options, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

static adcgs_stereo find(void)
{
    adcgs_stereo found = {.n_still = 0};
    const adcgs_stereo_options options = {.scale = 1.0, .still = 5000, .moving = 2000, .bodies = 8};
    assert_true(adcgs_splat_motion_applies(scene));
    if (adcgs_splat_motion_find(&found, scene, &options, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    print_message("%u static, %u moving, %u bodies (%u)\n", found.n_still, found.n_moving, found.n_bodies,
                  found.n_bodies ? found.body[0].n : 0);
    return found;
}

static void finish(adcgs_stereo *found)
{
    adcgs_stereo_clear(found);
    adcgs_scene_free(&scene);
}

/** The plane stands, the ball is one rigid body, flash and chain have lifetimes. */
static void test_identity(void **state)
{
    open_scene("splats4d/stg_lite/point_cloud.ply", 24);
    adcgs_stereo found = find();
    assert_int_equal(found.n_still, 1200);
    assert_int_equal(found.n_bodies, 1);
    assert_int_equal(found.body[0].n, 500);
    uint32_t ends = 0, rigid = 0;
    for (uint32_t i = 0; i < found.n_moving; i++) {
        ends += found.moving[i].end[1] > 0.0f;
        rigid += found.moving[i].body == 1;
    }
    assert_true(rigid == 500 * found.n_frames && ends > 0);
    finish(&found);
}

/** Rows of a decoded stream are splats. */
static void test_rows(void **state)
{
    open_scene("splats4d/plyseq", 0);
    adcgs_stereo found = find();
    finish(&found);
}

static void test_varying(void **state)
{
    open_scene("splats4d/plyseq_varying", 0);
    adcgs_stereo found = find();
    finish(&found);
}

/** Two groups of ten splats, the second turned by a right angle; two points have the means and deviations of the groups. */
static void test_static(void **state)
{
    char text[4096] = "ply\nformat ascii 1.0\nelement vertex 20\n";
    const char *const names[] = {"x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
                                 "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};
    size_t n = strlen(text);
    for (int i = 0; i < 14; i++)
        n += (size_t)snprintf(text + n, sizeof text - n, "property float %s\n", names[i]);
    n += (size_t)snprintf(text + n, sizeof text - n, "end_header\n");
    for (int i = 0; i < 20; i++)
        n += (size_t)snprintf(text + n, sizeof text - n, "%g 0 0 %d 0 0 2 -2.3025851 -2.9957323 -3.912023 1 0 0 %d\n",
                              (i < 10 ? 0 : 5) + 0.02 * (i % 10) - 0.09, i < 10, i >= 10);
    put_text("groups.ply", text);
    assert_int_equal(adcgs_scene_open(&scene, in("groups.ply"), NULL, &error), ADCGS_OK);
    adcgs_stereo found = {.n_still = 0};
    const adcgs_stereo_options options = {.scale = 2.0, .still = 2};
    assert_true(adcgs_splat_motion_applies(scene));
    assert_int_equal(adcgs_splat_motion_find(&found, scene, &options, &error), ADCGS_OK);
    assert_int_equal(found.n_still, 2);
    assert_int_equal(found.n_moving, 0);
    for (int i = 0; i < 2; i++) {
        const float extent[3] = {i ? 0.025f : 0.05f, i ? 0.05f : 0.025f, 0.01f};
        const double x[3] = {i ? 2.5 : 0.0, 0.0, 0.0};
        for (int a = 0; a < 3; a++) {
            assert_true(fabs(found.still[i].x[a] - x[a]) < 1e-5);
            assert_true(fabsf(found.still[i].extent[a] - extent[a]) < 1e-5f);
            assert_true(fabsf(found.still[i].spread[a] - fmaxf(extent[a], a ? 0.0f : 0.0287228f)) < 1e-5f);
        }
        assert_true(fabsf(found.still[i].rgb[0] - (i ? 0.5f : 0.782095f)) < 1e-4f);
    }
    finish(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_static),
        cmocka_unit_test(test_identity),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_varying),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
