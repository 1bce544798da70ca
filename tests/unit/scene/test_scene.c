/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes: both layouts, conventions, masks, moving parts, and real scenes where available. */
#include "scene_files.h"
#include "second_sources.h"

#include "scene/layouts/open.h"
#include "scene/pose_check.h"
#include "scene/scene.h"

#include <math.h>

static void test_single(void **state)
{
    expect_good(
        open_single("{\"w\":6,\"h\":4,\"fl_x\":5,\"camera_model\":\"OPENCV\",\"k1\":0,\"p2\":0.0,\"fps\":25,\"frames\":"
                    "[" FRAME("a.ppm", "") "," FRAME("b.ppm", ",\"fl_x\":7,\"cx\":1.5,\"cy\":2.25") "," FRAME("a.ppm", "") "]}"));
    expect_views(2, 0, 1);
    assert_true(scene->n_times == 1 && scene->duration == 0.0 && adcgs_fps_value(scene->rate) == 25.0 && !scene->has_alpha);
    assert_true(scene->background[0] == 0.0f && scene->points.n == 0);
    const adcgs_camera *c = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    assert_true(c->width == 6 && c->height == 4 && c->fx == 7.0 && c->fy == 7.0 && c->cx == 1.5 && c->cy == 2.25);
    assert_string_equal(c->name, "b");
    /* OpenGL looks along -z: in OpenCV axes x stays, y and z are inverted; the centre stays. */
    const double expected[12] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 4};
    for (int i = 0; i < 12; i++)
        assert_true(c->cam_to_world[i] == expected[i]);
    const adcgs_camera *d = &scene->views[ADCGS_SPLIT_TRAIN][1].camera;
    assert_true(d->fx == 5.0 && d->cx == 3.0 && d->cy == 2.0);
    adcgs_scene_free(&scene);
}

static void test_filename_lists(void **state)
{
    expect_good(open_single("{\"fl_x\":5,\"train_filenames\":[\"b.ppm\"],\"val_filenames\":[\"a.ppm\"],\"frames\":[" FRAME(
        "a.ppm", "") "," FRAME("b.ppm", "") "," FRAME("c.tif", "") "]}"));
    expect_views(1, 1, 0);
    adcgs_scene_free(&scene);
    expect_bad("{\"fl_x\":5,\"train_filenames\":[],\"frames\":[" FRAME("a.ppm", "") "]}", ADCGS_ERR_DATA, "frames", "training");
}

/** Times, extensions, alpha, field of view, initial points. */
static void test_split_files(void **state)
{
    put_text("transforms_train.json",
             "{\"camera_angle_x\":1.5707963267948966,\"frames\":[" FRAME("./c", ",\"time\":0.0") "," FRAME(
                 "c.tif", ",\"time\":0.5") "," FRAME("c", ",\"time\":1.0") "," FRAME("c", ",\"time\":1") "]}");
    put_text("transforms_test.json", "{\"camera_angle_x\":1.5707963267948966,\"frames\":[" FRAME("./c", ",\"time\":0.75") "]}");
    put_text("points3d.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                             "end_header\n1 2 3\n");
    char path[512];
    snprintf(path, sizeof path, "%s///", folder);
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
    expect_views(4, 0, 1);
    assert_true(scene->n_times == 3 && adcgs_fps_value(scene->rate) == 30.0 && scene->duration == 2.0 / 30.0);
    assert_true(fabs(scene->views[ADCGS_SPLIT_TEST][0].time - 0.05) < 1e-12);
    assert_true(scene->has_alpha && scene->background[1] == 1.0f && scene->points.n == 1);
    const adcgs_camera *c = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    assert_true(c->width == 6 && c->height == 4 && fabs(c->fx - 3.0) < 1e-12 && fabs(c->fy - 3.0) < 1e-12);
    adcgs_scene_free(&scene);

    const adcgs_scene_options options = {.has_background = 1,
                                         .background = {0.25f, 0.5f, 1.0f},
                                         .rate = {10, 1},
                                         .points_path = in("missing.ply")};
    expect_error(adcgs_scene_open(&scene, folder, &options, &error), ADCGS_ERR_IO, "missing.ply", "No such file");
}

#define TIMED(time) FRAME("b.ppm", ",\"time\":" time)

static void put_times(const char *train, const char *test)
{
    char text[2000];
    snprintf(text, sizeof text, "{\"fl_x\":5%s]}", train);
    put_text("transforms_train.json", text);
    snprintf(text, sizeof text, "{\"fl_x\":5%s]}", test);
    put_text("transforms_test.json", text);
}

static void expect_time(const char *train, const char *test, uint32_t num, uint32_t den, double frames)
{
    put_times(train, test);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    assert_true(scene->rate.num == num && scene->rate.den == den && scene->duration == frames * den / num);
    adcgs_scene_free(&scene);
}

/** All splits together determine the frame times; any of them the frame rate. */
static void test_duration(void **state)
{
    const char *const ends = ",\"frames\":[" TIMED("0") "," TIMED("1");
    /* Every third frame is for testing; six digits are enough. */
    expect_time(",\"frames\":[" TIMED("0") "," TIMED("0.166667") "," TIMED("0.5") "," TIMED("0.666667") "," TIMED("1"),
                ",\"frames\":[" TIMED("0.333333") "," TIMED("0.833333"), 30, 1, 6);
    /* The last frames are for testing. */
    expect_time(",\"frames\":[" TIMED("0") "," TIMED("0.25") "," TIMED("0.5"), ",\"frames\":[" TIMED("0.75") "," TIMED("1"), 30,
                1, 4);
    /* Test frames between evenly spaced training frames add no intervals. */
    expect_time(",\"frames\":[" TIMED("0") "," TIMED("0.5") "," TIMED("1"), ",\"frames\":[" TIMED("0.25") "," TIMED("0.75"), 30,
                1, 2);
    /* No view is at the end of the third of four intervals. */
    expect_time(",\"frames\":[" TIMED("0") "," TIMED("0.25") "," TIMED("1"), ",\"frames\":[" TIMED("0.5"), 30, 1, 4);
    /* Test views with times of their own, as in D-NeRF: the three intervals of training count, not seventeen or five. */
    expect_time(",\"frames\":[" TIMED("0") "," TIMED("0.3333333") "," TIMED("0.6666667") "," TIMED("1"),
                ",\"frames\":[" TIMED("0.41") "," TIMED("0.77"), 30, 1, 3);
    expect_time(ends, ",\"fps\":29.97,\"frames\":[" TIMED("0.5"), 30000, 1001, 1);
    expect_time(",\"fps\":\"24000/1001\",\"frames\":[" TIMED("0") "," TIMED("1"), ",\"fps\":23.976,\"frames\":[" TIMED("0.5"),
                24000, 1001, 1);
    put_times(",\"fps\":25,\"frames\":[" TIMED("0"), ",\"fps\":30,\"frames\":[" TIMED("0.5"));
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "transforms_test.json", "fps: 30, but 25");
    put_times(",\"fps\":\"25/0\",\"frames\":[" TIMED("0"), ends);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "transforms_train.json: fps", "30000/1001");
    unlink(in("transforms_train.json"));
    unlink(in("transforms_test.json"));
}

/** Black areas of the mask are unknown, in a pixel and in the average of a reduced one. */
static void test_mask(void **state)
{
    adcgs_image mask;
    float *rgb;
    adcgs_camera camera;
    assert_int_equal(adcgs_image_alloc(&mask, 6, 4, 1, "m", &error), ADCGS_OK);
    for (int i = 0; i < 6 * 4; i++) /* the last three columns, and one pixel of the second pair */
        mask.data[i] = i % 6 < 3 && i != 8 ? 1.0f / 255.0f : 0.0f;
    expect_good(adcgs_image_write(&mask, in("m.pgm"), 0, &error));
    expect_good(adcgs_image_write(&mask, in("m.tif"), 0, &error));
    adcgs_image_free(&mask);
    for (int tiff = 0; tiff < 2; tiff++) {
        char json[1000];
        snprintf(json, sizeof json,
                 "{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", "") "," FRAME("b.ppm", ",\"mask_path\":\"./m.%s\"") "," FRAME(
                     "b.ppm", ",\"mask_path\":null") "]}",
                 tiff ? "tif" : "pgm");
        expect_good(open_single(json));
        const adcgs_scene_view *view = scene->views[ADCGS_SPLIT_TRAIN];
        assert_true(view[0].mask && !view[1].mask && !scene->views[ADCGS_SPLIT_TEST][0].mask);
        expect_good(adcgs_scene_image(scene, view, 1, &rgb, NULL, &error));
        for (int i = 0; i < 3 * 24; i++)
            assert_true(i % 6 < 3 && i % 24 != 8 ? rgb[i] == (float)(3 * (i % 24) + i / 24) / 255.0f : isnan(rgb[i]));
        free(rgb);
        expect_good(adcgs_scene_image(scene, view, 2, &rgb, &camera, &error));
        assert_true(camera.width == 3 && camera.height == 2);
        for (int c = 0; c < 3; c++) {
            const float *plane = rgb + 6 * c;
            /* All four pixels; one of two that are left of four, above one that has one; none. */
            assert_true(fabsf(plane[0] - (float)(3 * 0 + 3 * 1 + 3 * 6 + 3 * 7 + 4 * c) / 4.0f / 255.0f) < 1e-6f);
            assert_true(isnan(plane[1]) && isnan(plane[2]) && isnan(plane[5]));
            assert_true(fabsf(plane[4] - (float)(3 * 14 + 3 * 20 + 2 * c) / 2.0f / 255.0f) < 1e-6f);
        }
        free(rgb);
        adcgs_scene_free(&scene);
    }
    expect_bad("{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", "") "," FRAME("b.ppm", ",\"mask_path\":\"none.png\"") "]}",
               ADCGS_ERR_DATA, "frames[1].mask_path", "no such image: none.png");
    expect_bad("{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", "") "," FRAME("b.ppm", ",\"mask_path\":7") "]}", ADCGS_ERR_DATA,
               "frames[1].mask_path", "expected the name");
    assert_int_equal(adcgs_image_alloc(&mask, 5, 4, 1, "m", &error), ADCGS_OK);
    memset(mask.data, 0, 20 * sizeof *mask.data);
    expect_good(adcgs_image_write(&mask, in("m.pgm"), 0, &error));
    adcgs_image_free(&mask);
    const char *const narrow = "{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", "%s") "," FRAME("b.ppm", "%s") "]}";
    char json[1000];
    snprintf(json, sizeof json, narrow, "", ",\"mask_path\":\"m.pgm\"");
    expect_error(open_single(json), ADCGS_ERR_DATA, "m.pgm: 5x4", "6x4"); /* the first mask for training is checked, too */
    snprintf(json, sizeof json, narrow, ",\"mask_path\":\"m.pgm\"", "");
    expect_error(open_single(json), ADCGS_ERR_DATA, "m.pgm: 5x4", "6x4");
}

/** The motion mask: any colour but black moves. It is for measurements, so that the image itself stays unchanged. */
static void test_moving(void **state)
{
    adcgs_image mask;
    uint8_t *moving;
    float *rgb;
    expect_good(adcgs_image_alloc(&mask, 6, 4, 1, "m", &error));
    for (int i = 0; i < 6 * 4; i++)
        mask.data[i] = i % 5 ? 0.0f : 1.0f / 255.0f;
    expect_good(adcgs_image_write(&mask, in("m.pgm"), 0, &error));
    adcgs_image_free(&mask);
    const char *const frames = "{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", "%s") "," FRAME("b.ppm", "%s") "]}";
    char json[1000];
    snprintf(json, sizeof json, frames, ",\"moving_path\":\"./m.pgm\"", ",\"moving_path\":null");
    expect_good(open_single(json));
    const adcgs_scene_view *view = scene->views[ADCGS_SPLIT_TEST];
    assert_true(view->moving && !view->mask && !scene->views[ADCGS_SPLIT_TRAIN][0].moving);
    expect_good(adcgs_scene_load_moving(view, 1, &moving, &error));
    for (int i = 0; i < 6 * 4; i++)
        assert_int_equal(moving[i], i % 5 == 0);
    free(moving);
    expect_good(adcgs_scene_image(scene, view, 1, &rgb, NULL, &error));
    for (int i = 0; i < 3 * 24; i++)
        assert_false(isnan(rgb[i]));
    free(rgb);
    adcgs_scene_free(&scene);
    snprintf(json, sizeof json, frames, "", ",\"moving_path\":\"none.png\"");
    expect_bad(json, ADCGS_ERR_DATA, "frames[1].moving_path", "no such image: none.png");
    snprintf(json, sizeof json, frames, ",\"moving_path\":7", "");
    expect_bad(json, ADCGS_ERR_DATA, "frames[0].moving_path", "expected the name");
    snprintf(json, sizeof json, frames, ",\"mask_path\":\"m.pgm\",\"moving_path\":\"\"", "");
    expect_bad(json, ADCGS_ERR_DATA, "frames[0].moving_path", "expected the name");
    put_text("m.pgm", "P5 5 4 255 12345678901234567890");
    snprintf(json, sizeof json, frames, ",\"moving_path\":\"m.pgm\"", "");
    expect_error(open_single(json), ADCGS_ERR_DATA, "m.pgm: 5x4", "6x4");
    put_text("m.pgm", "");
    expect_error(open_single(json), ADCGS_ERR_DATA, "m.pgm", "");
}

static void test_load(void **state)
{
    expect_good(open_single("{\"fl_x\":5,\"frames\":[" FRAME("c", "") "," FRAME("c", ",\"w\":6,\"h\":4") "]}"));
    const adcgs_scene_view *view = &scene->views[ADCGS_SPLIT_TRAIN][0];
    float *rgb;
    adcgs_camera camera;
    expect_good(adcgs_scene_image(scene, view, 1, &rgb, &camera, &error));
    assert_true(camera.width == 6 && camera.height == 4 && camera.fx == 5.0);
    assert_true(rgb[0] == 1.0f && rgb[24] == 1.0f); /* transparent: white */
    assert_true(rgb[3] == 12.0f / 255.0f && rgb[24 + 3] == 13.0f / 255.0f && rgb[48 + 3] == 14.0f / 255.0f); /* opaque */
    float small[3] = {0};
    for (int c = 0; c < 3; c++)
        for (int y = 3; y < 4; y++)
            for (int x = 3; x < 6; x++)
                small[c] += rgb[c * 24 + y * 6 + x] / 3.0f;
    free(rgb);
    expect_good(adcgs_scene_image(scene, view, 3, &rgb, &camera, &error));
    assert_true(camera.width == 2 && camera.height == 2 && fabs(camera.fx - 5.0 / 3.0) < 1e-12 && camera.cx == 1.0);
    for (int c = 0; c < 3; c++)
        assert_true(fabsf(rgb[4 * c + 3] - small[c]) < 1e-6f); /* the last box covers one row */
    free(rgb);
    expect_error(adcgs_scene_image(scene, view, 0, &rgb, NULL, &error), ADCGS_ERR_USAGE, "c.tif", "0");
    adcgs_scene_view wrong = *view;
    wrong.camera.width = 7;
    expect_error(adcgs_scene_image(scene, &wrong, 1, &rgb, NULL, &error), ADCGS_ERR_DATA, "6x4", "7x4");
    assert_null(rgb);
    adcgs_scene_free(&scene);
}

/** Poses with rounding errors are made orthonormal. */
static void test_straightening(void **state)
{
    double pose[12] = {0.8003, -0.6, 0.0, 1, 0.6001, 0.7998, 0.0002, 2, -0.0003, 0.0, 1.0001, 3};
    assert_null(adcgs_pose_from_opengl(pose));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double dot = 0.0;
            for (int k = 0; k < 3; k++)
                dot += pose[4 * i + k] * pose[4 * j + k];
            assert_true(fabs(dot - (i == j)) < 1e-12);
        }
    assert_true(fabs(pose[0] - 0.8) < 1e-3 && pose[3] == 1.0 && pose[11] == 3.0);
}

/** Times in one split file and none in another contradict each other. */
static void test_mixed_times(void **state)
{
    put_text("transforms_train.json", "{\"fl_x\":5,\"frames\":[" FRAME("a", ",\"time\":0.0") "]}");
    put_text("transforms_test.json", "{\"fl_x\":5,\"frames\":[" FRAME("a", "") "]}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "transforms_test.json", "time");
    put_text("transforms_test.json", "{\"fl_x\":5,\"frames\":[]}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "transforms_test.json", "empty");
}

static void check_real(const char *name, uint32_t train, uint32_t val, uint32_t test, uint32_t times, int size)
{
    const char *path = real_data(name);
    expect_good(adcgs_scene_open(&scene, path, NULL, &error));
    expect_views(train, val, test);
    assert_int_equal(scene->n_times, times);
    float *rgb;
    adcgs_camera camera;
    expect_good(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TEST][test - 1], 1, &rgb, &camera, &error));
    assert_true(camera.width == size && camera.height == size);
    free(rgb);
}

static void test_robot(void **state)
{
    check_real("synth_robot_dnerf", 100, 10, 20, 100, 400);
    assert_true(scene->has_alpha && scene->background[0] == 1.0f);
    assert_true(scene->views[0][0].camera.near_plane > 0.02 && scene->views[0][0].camera.near_plane < 0.05);
    adcgs_scene_free(&scene);
}

/** The triangulated initial points are inside the images of cameras with their own intrinsics. */
static void test_ring(void **state)
{
    check_real("zju313_15f", 255, 30, 30, 15, 512);
    assert_int_equal(scene->points.n, 1313);
    for (uint32_t v = 0; v < scene->n_views[0]; v += 15) {
        const adcgs_camera *c = &scene->views[0][v].camera;
        const double *m = c->cam_to_world;
        uint32_t inside = 0;
        for (uint32_t i = 0; i < scene->points.n; i++) {
            double p[3];
            for (int a = 0; a < 3; a++)
                p[a] = m[a] * (scene->points.position[i][0] - m[3]) + m[4 + a] * (scene->points.position[i][1] - m[7]) +
                       m[8 + a] * (scene->points.position[i][2] - m[11]);
            const double x = c->fx * p[0] / p[2] + c->cx, y = c->fy * p[1] / p[2] + c->cy;
            inside += p[2] > 0.0 && x >= 0.0 && x <= c->width && y >= 0.0 && y <= c->height;
        }
        assert_true(inside > scene->points.n * 9 / 10);
    }
    adcgs_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_single, no_files),
        cmocka_unit_test_teardown(test_filename_lists, no_files),
        cmocka_unit_test_teardown(test_split_files, no_files),
        cmocka_unit_test_teardown(test_duration, no_files),
        cmocka_unit_test_teardown(test_load, no_files),
        cmocka_unit_test_teardown(test_mask, no_files),
        cmocka_unit_test_teardown(test_moving, no_files),
        cmocka_unit_test_teardown(test_straightening, no_files),
        cmocka_unit_test_teardown(test_mixed_times, no_files),
        cmocka_unit_test(test_robot),
        cmocka_unit_test(test_ring),
    };
    int failed = cmocka_run_group_tests(tests, setup, remove_folder);
    failed += adcgs_test_scene_faults();
    return failed;
}
