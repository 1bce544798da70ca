/* SPDX-License-Identifier: BSD-2-Clause */
/** \file COLMAP models from other users: far from the origin, without second lines, several of them. */
#include "layout_files.h"
#include "opened_scene.h"

#include "train/settings.h"
#include "train/start_points.h"

#define CAMERA "7 PINHOLE 24 16 20 20 12 8\n"

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
        at += (size_t)sprintf(text + at, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 7 %d.ppm\n\n", i + 1, q[0], q[1], q[2],
                              q[3], t[0], t[1], t[2], i);
    }
    put_text("sparse/images.txt", text);
    at = 0;
    for (int i = 0; i < RIG_POINTS; i++) {
        double x[3];
        rig_point(i, x);
        at +=
            (size_t)sprintf(text + at, "%d %.17g %.17g %.17g 9 9 9 0.5\n", i, x[0] + place[0], x[1] + place[1], x[2] + place[2]);
    }
    put_text("sparse/points3D.txt", text);
    free(text);
}

/** Points of the start, in the units of the open scene. */
static void start(adcgs_start_points *points)
{
    adcgs_train_config config;
    adcgs_stereo none = {.n_still = 0};
    expect_good(adcgs_train_preset(&config, "draft", &error));
    config.start_anchors = 200;
    expect_good(adcgs_start_points_find(points, scene, &config, &none, &error));
}

/**
 * From the files to the start, cameras and points keep their relative places to a tenth of a millimetre, anywhere in the world.
 */
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

/* ---- Lines of images ---- */

/** Writes images.txt with a second line behind the line of each image, and with these line ends. */
static void put_lines(const char *second, const char *end, int last_second)
{
    char *text = malloc(65536);
    size_t at = (size_t)sprintf(text, "# remark%s", end);
    assert_non_null(text);
    for (int i = 0; i < 9; i++) {
        double pose[12], q[4], t[3];
        rig_pose(i, pose);
        rig_quaternion(pose, q, t);
        at += (size_t)sprintf(text + at, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 7 %d.ppm%s%s%s", i + 1, q[0], q[1], q[2],
                              q[3], t[0], t[1], t[2], i, end, i < 8 || last_second ? second : "",
                              *second && (i < 8 || last_second) ? end : "");
    }
    put_text("sparse/images.txt", text);
    free(text);
}

static void expect_nine(void)
{
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN] + scene->n_views[ADCGS_SPLIT_TEST], 9);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t v = 0; v < scene->n_views[s]; v++)
            expect_pose(&scene->views[s][v], atoi(scene->views[s][v].camera.name), 1.0, 1e-12);
}

/** No image is skipped, for any content in the place of its list of points and for any line ends. */
static void test_lines(void **state)
{
    static const char *const ends[] = {"\n", "\r\n", "\r", "\r\r\n"};
    static const char *const seconds[] = {"",      " ",           "1.5 2.5 -1",        "1 2 3 4.5 5 -1 \t",
                                          "# 1 2", "# a\n1 2 -1", "\t# of points: 0\n"};
    static char longer[6000];
    put_images(9, "images", "%d.ppm");
    put_model_at((const double[3]){0.0, 0.0, 0.0}, 9);
    for (size_t e = 0; e < ADCGS_COUNTOF(ends); e++) {
        char text[256];
        snprintf(text, sizeof text, "# cameras%s7 PINHOLE 24 16 20 20 12 8%s", ends[e], ends[e]);
        put_text("sparse/cameras.txt", text);
        snprintf(text, sizeof text, "# points%s1 0 0 0 9 9 9 0.5%s2 0 0 0 9 9 9 .5 1 2%s3 0 0 1 9 9 9 .5 2 1 3 1", ends[e],
                 ends[e], ends[e]);
        put_text("sparse/points3D.txt", text);
        for (size_t i = 0; i < ADCGS_COUNTOF(seconds); i++)
            for (int last = 0; last < 2; last++) {
                put_lines(seconds[i], ends[e], last);
                expect_nine();
                assert_int_equal(scene->points.n, 2); /* the second is seen by one image only */
            }
    }
    for (size_t i = 0; i + 12 < sizeof longer; i += 12)
        memcpy(longer + i, "100.5 7 -1  ", 13);
    put_lines(longer, "\n", 1);
    expect_nine();
}

static void test_bad_lines(void **state)
{
    static const char *const seconds[] = {"1.5 2.5", "1.5 2.5 -1 7", "1 2 3.5", "a b c", "1 0 0 0 a 0 0 0 7 x.ppm"};
    put_images(9, "images", "%d.ppm");
    put_model_at((const double[3]){0.0, 0.0, 0.0}, 9);
    for (size_t i = 0; i < ADCGS_COUNTOF(seconds); i++) {
        put_lines(seconds[i], "\n", 1);
        expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "images.txt: line 3", "nor the next image");
    }
}

/* ---- Several models ---- */

/** Expects a remark about the scene with both parts. */
static void expect_remark(const char *first, const char *second)
{
    for (int i = 0; i < scene->n_remarks; i++)
        if (strstr(scene->remarks[i], first) && strstr(scene->remarks[i], second))
            return;
    fail_msg("no remark says \"%s\" and \"%s\"; there are %d", first, second, scene->n_remarks);
}

static void expect_views(uint32_t n, int n_remarks)
{
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN] + scene->n_views[ADCGS_SPLIT_TEST], n);
    assert_int_equal(scene->n_remarks, n_remarks);
}

/** The largest model is used. Remarks name the others and count images without a pose. */
static void test_several(void **state)
{
    put_images(9, "images", "%d.ppm");
    put_folder("sparse");
    put_folder("sparse/0");
    put_model_text("sparse/0", 4, "%d.ppm", CAMERA);
    expect_views(4, 1);
    expect_remark("5 of 9 images in images/ have no pose", "");
    put_folder("sparse/1");
    put_model_binary("sparse/1", 9, "%d.ppm");
    expect_views(9, 1);
    expect_remark("2 models", "sparse/1 with 9 images is used; sparse/0 has 4");
    put_folder("sparse/12");
    put_model_text("sparse/12", 9, "%d.ppm", CAMERA); /* equal size: the first wins */
    put_folder("sparse/x");
    put_model_text("sparse/x", 9, "%d.ppm", CAMERA); /* not a number */
    expect_views(9, 1);
    expect_remark("3 models", "sparse/1 with 9 images is used; sparse/12 has 9");
    put_text("sparse/12/images.txt", "no such thing");
    expect_views(9, 1);
    expect_remark("3 models", "sparse/0 has 4");
    put_text("sparse/1/images.bin", "no such thing");
    put_text("sparse/0/images.txt", "no such thing");
    adcgs_scene_free(&scene);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "sparse/0/images.txt: line 1", "IMAGE_ID");
}

/** The places in which other programs put models. */
static void test_places(void **state)
{
    static const char *const places[] = {"distorted/sparse/0", "colmap/sparse/0", "sparse/3"};
    static const char *const folders[] = {"distorted", "distorted/sparse", "colmap", "colmap/sparse", "sparse"};
    put_images(9, "input", "%d.ppm");
    for (size_t i = 0; i < ADCGS_COUNTOF(folders); i++)
        put_folder(folders[i]);
    for (size_t i = 0; i < ADCGS_COUNTOF(places); i++) {
        put_folder(places[i]);
        put_model_text(places[i], 6 + (int)i, "%d.ppm", CAMERA);
        expect_views(6 + (uint32_t)i, 1);
        expect_remark(i == 2 ? "1 of 9 images in input/ has no pose" : "of 9 images in input/ have no pose", "left out");
    }
}

/** Images in folders, also with Windows' separators. Images with a pose are recognised by their names without extension. */
static void test_folders(void **state)
{
    put_folder("images");
    put_images(9, "images/left", "%d.ppm");
    put_folder("sparse");
    put_model_text("sparse", 9, "left\\%d.jpg", CAMERA);
    expect_views(9, 0);
    assert_string_equal(scene->views[ADCGS_SPLIT_TRAIN][0].camera.name, "left_1");
    put_images(2, "images/right", "%d.ppm");
    expect_views(9, 1);
    expect_remark("2 of 11 images in images/", "");
}

/** Names that begin with ./ or differ in letter case or extension find their images and masks. */
static void test_likeness(void **state)
{
    static const char *const names[] = {"./%d.ppm", "%d.PPM", "%d.Jpeg"};
    put_images(9, "images", "%d.ppm");
    put_images(9, "masks", "%d.ppm");
    put_folder("sparse");
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++) {
        put_model_text("sparse", 9, names[i], CAMERA);
        expect_views(9, 0);
        assert_string_equal(scene->views[ADCGS_SPLIT_TRAIN][0].camera.name, "1");
        assert_non_null(scene->views[ADCGS_SPLIT_TRAIN][0].mask);
    }
    assert_int_equal(remove(in("masks/3.ppm")), 0); /* reported */
    expect_views(9, 1);
    expect_remark("folder masks exists, but 1 of 9 images has no mask of", "no pixels of it are masked");
    assert_int_equal(remove(in("images/0.ppm")), 0);
    adcgs_scene_free(&scene);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "images/0.Jpeg: no such image", "");
}

/** Each file of a model is read in the format that exists, independently of the other files. */
static void test_mixed(void **state)
{
    static const char *const files[] = {"cameras", "images", "points3D"};
    put_images(9, "images", "%d.ppm");
    put_folder("sparse");
    put_model_binary("sparse", 9, "%d.ppm");
    put_model_text("sparse", 9, "%d.ppm", CAMERA);
    expect_views(9, 0);
    put_text("sparse/cameras.txt", "7 PINHOLE 24 16 30 30 12 8\n"); /* differs from the binary file */
    expect_views(9, 1);
    expect_remark("cameras.bin is read, but cameras.txt differs from it", "");
    assert_true(scene->views[ADCGS_SPLIT_TRAIN][0].camera.fx == RIG_FOCAL);
    put_model_text("sparse", 8, "%d.ppm", CAMERA);
    expect_views(9, 1);
    expect_remark("images.bin is read, but images.txt differs", "");
    for (int bits = 0; bits < 8; bits++) {
        put_model_text("sparse", 9, "%d.ppm", CAMERA);
        put_model_binary("sparse", 9, "%d.ppm");
        for (int f = 0; f < 3; f++) {
            char name[40];
            snprintf(name, sizeof name, "sparse/%s.%s", files[f], bits >> f & 1 ? "bin" : "txt");
            assert_int_equal(remove(in(name)), 0);
        }
        expect_views(9, 0);
        assert_int_equal(scene->points.n, count_kept_points(9, 8));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_far, clean),       cmocka_unit_test_teardown(test_lines, clean),
        cmocka_unit_test_teardown(test_bad_lines, clean), cmocka_unit_test_teardown(test_several, clean),
        cmocka_unit_test_teardown(test_places, clean),    cmocka_unit_test_teardown(test_folders, clean),
        cmocka_unit_test_teardown(test_likeness, clean),  cmocka_unit_test_teardown(test_mixed, clean),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
