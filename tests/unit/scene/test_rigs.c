/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * LLFF, Neu3D and COLMAP: every convention on a small rig, every kind of bad input. The second source opens real scenes.
 */
#include "layout_files.h"
#include "opened_scene.h"
#include "second_sources.h"

static void open_good(void)
{
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
}

static void expect_bad(adcgs_status status, const char *first, const char *second)
{
    adcgs_scene_free(&scene);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), status, first, second);
}

/* ---- LLFF and Neu3D ---- */

static void put_llff(int n, const char *place)
{
    put_folder(place);
    for (int i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/%02d.ppm", place, i);
        put_picture(name, i, RIG_WIDTH, RIG_HEIGHT);
    }
    put_poses(n, 8);
}

static void test_llff(void **state)
{
    put_llff(10, "images_8");
    open_good();
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 8 && scene->n_views[ADCGS_SPLIT_TEST] == 2);
    assert_true(scene->n_times == 1 && scene->duration == 0.0 && scene->axes == ADCGS_AXES_Y_DOWN && scene->points.n == 0);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t v = 0; v < scene->n_views[s]; v++) {
            const adcgs_camera *c = &scene->views[s][v].camera;
            const int i = atoi(c->name);
            assert_int_equal(s, i % 8 ? ADCGS_SPLIT_TRAIN : ADCGS_SPLIT_TEST);
            expect_pose(&scene->views[s][v], i, 1.0, 1e-14);
            assert_true(c->width == RIG_WIDTH && c->height == RIG_HEIGHT && c->fx == RIG_FOCAL && c->fy == RIG_FOCAL);
            assert_true(c->cx == 0.5 * RIG_WIDTH && c->cy == 0.5 * RIG_HEIGHT && c->near_plane == 0.5 * 2.01);
        }
    put_folder("images"); /* full size has priority over reduced images */
    for (int i = 0; i < 10; i++) {
        char name[64];
        snprintf(name, sizeof name, "images/%d.ppm", i);
        put_picture(name, i, 2 * RIG_WIDTH, 2 * RIG_HEIGHT);
    }
    open_good();
    assert_true(scene->views[ADCGS_SPLIT_TRAIN][0].camera.fx == 2 * RIG_FOCAL);
}

/** Points of a COLMAP model next to the poses, except those that depend on test views. */
static void test_llff_points(void **state)
{
    put_llff(10, "images");
    put_folder("sparse");
    put_model_binary("sparse", 10, "%02d.ppm");
    open_good();
    assert_true(scene->points.n == count_kept_points(10, 8) && scene->points.n < RIG_POINTS && scene->points.coloured);
    unlink(in("sparse/images.bin")); /* the ids 10, 11, ... then belong to no image */
    open_good();
    assert_int_equal(scene->points.n, 0);
}

static void test_bad_poses(void **state)
{
    put_llff(3, "images");
    put_poses(4, 1);
    expect_bad(ADCGS_ERR_DATA, "poses_bounds.npy: 4 poses", "there are 3 images");
    put_poses(3, 1);
    static uint8_t data[128 + 3 * 136], changed[sizeof data];
    FILE *file = fopen(in("poses_bounds.npy"), "rb");
    assert_int_equal(fread(data, 1, sizeof data, file), sizeof data);
    fclose(file);
    static const struct {
        int number;
        double value;
        const char *what;
    } cases[] = {{17, NAN, "row 1: the matrix holds a value that is not finite"},
                 {20, INFINITY, "row 1: the position"},
                 {21, 0, "row 1: height and width"},
                 {26, 1e300, "row 1: height and width"},
                 {31, NAN, "row 1: the focal length"},
                 {31, -5, "row 1: the focal length"},
                 {32, -1, "poses_bounds.npy: row 1: bounds of depth -1 and "},
                 {32, NAN, "row 1: bounds of depth nan and "},
                 {33, 0.5, " and 0.5, expected 0 < near < far"},
                 {33, NAN, " and nan, expected 0 < near < far"},
                 {33, INFINITY, " and inf, expected 0 < near < far <= 1e+09"},
                 {15, NAN, "row 0: bounds of depth nan and "}, /* of a test view */
                 {16, 0.5, "row 0: bounds of depth"},
                 {21, 10, "another aspect ratio"},
                 {17, 3, "row 1: the matrix is"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        memcpy(changed, data, sizeof data);
        adcgs_store_le64(changed + 128 + 8 * cases[i].number, adcgs_double_bits(cases[i].value));
        put_bytes("poses_bounds.npy", changed, sizeof changed);
        expect_bad(ADCGS_ERR_DATA, folder, cases[i].what);
    }
    for (size_t n = 0; n < sizeof data; n += n < 140 ? 1 : 50) { /* cut short */
        put_bytes("poses_bounds.npy", data, n);
        expect_bad(ADCGS_ERR_DATA, "poses_bounds.npy", "");
    }
    memcpy(changed, data, sizeof data);
    memcpy(strstr((char *)changed + 10, "(3, 17)"), "(3, 5) ", 7);
    put_bytes("poses_bounds.npy", changed, sizeof changed);
    expect_bad(ADCGS_ERR_DATA, "shape", "expected (n, 17)");
}

static void test_bad_files(void **state)
{
    const adcgs_scene_options llff = {.dataset = ADCGS_DATASET_LLFF};
    put_llff(3, "images");
    unlink(in("poses_bounds.npy"));
    assert_int_equal(symlink("poses_bounds.npy", in("poses_bounds.npy")), 0);
    expect_error(adcgs_scene_open(&scene, folder, &llff, &error), ADCGS_ERR_IO, "poses_bounds.npy", "symbolic links");
    unlink(in("poses_bounds.npy"));
    put_poses(3, 1);
    if (geteuid()) {
        chmod(in("poses_bounds.npy"), 0);
        expect_bad(ADCGS_ERR_IO, "poses_bounds.npy", "Permission denied");
        chmod(in("poses_bounds.npy"), 0600);
    }
    put_text("images/01.ppm", "");
    expect_bad(ADCGS_ERR_DATA, "01.ppm", "");
    assert_true(!unlink(in("images/01.ppm")) && !symlink("01.ppm", in("images/01.ppm")));
    expect_bad(ADCGS_ERR_IO, "01.ppm", "symbolic links");
    assert_true(!unlink(in("images/01.ppm")) && !unlink(in("images/00.ppm")) && !unlink(in("images/02.ppm")));
    expect_bad(ADCGS_ERR_DATA, "3 poses", "0 images");
    assert_int_equal(rmdir(in("images")), 0);
    expect_bad(ADCGS_ERR_DATA, folder, "neither videos cam00.mp4");
    put_folder("cam00");
    put_folder("cam01");
    expect_bad(ADCGS_ERR_DATA, "3 poses", "2 folders of cameras");
    put_poses(2, 1);
    expect_bad(ADCGS_ERR_DATA, "cam00: no image", "");
    put_picture("cam00/0.ppm", 0, RIG_WIDTH, RIG_HEIGHT);
    put_picture("cam00/1.ppm", 0, RIG_WIDTH, RIG_HEIGHT);
    put_picture("cam01/0.ppm", 0, RIG_WIDTH, RIG_HEIGHT);
    expect_bad(ADCGS_ERR_DATA, "cam00 has 2 frames", "cam01 has 1");
    put_picture("cam01/1.ppm", 0, RIG_WIDTH, RIG_WIDTH);
    put_picture("cam01/0.ppm", 0, RIG_WIDTH, RIG_WIDTH);
    expect_bad(ADCGS_ERR_DATA, "cam01/0.ppm: 24x24", "24x16");
}

/** Videos at half the size of the poses. The first by name is for testing. */
static void test_neu3d(void **state)
{
    static const int numbers[] = {0, 2, 10}; /* some are missing, as in the published scenes */
    for (size_t i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "cam%02d.mp4", numbers[i]);
        if (!put_video(name, (int)i, 5, RIG_WIDTH, RIG_HEIGHT)) {
            print_message("skipped: this build writes no videos\n");
            skip();
        }
    }
    put_poses(3, 2);
    open_good();
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 10 && scene->n_views[ADCGS_SPLIT_TEST] == 5 && scene->n_times == 5);
    assert_true(adcgs_fps_value(scene->rate) == 25.0 && fabs(scene->duration - 0.16) < 1e-15 && !scene->has_alpha);
    for (int f = 0; f < 5; f++) {
        const adcgs_scene_view *test = &scene->views[ADCGS_SPLIT_TEST][f], *last = &scene->views[ADCGS_SPLIT_TRAIN][5 + f];
        assert_true(test->is_video && test->frame == f && last->frame == f && fabs(test->time - f / 25.0) < 1e-15);
        assert_string_equal(test->camera.name, "cam00");
        assert_string_equal(last->camera.name, "cam10");
        assert_true(last->camera.fx == RIG_FOCAL && last->camera.near_plane == 0.5 * 2.01);
        expect_pose(test, 0, 1.0, 1e-14);
        expect_pose(last, 2, 1.0, 1e-14);
    }
    put_video("cam02.mp4", 1, 4, RIG_WIDTH, RIG_HEIGHT);
    expect_bad(ADCGS_ERR_DATA, "cam00.mp4 has 5 frames", "cam02.mp4 has 4");
    put_poses(2, 2);
    expect_bad(ADCGS_ERR_DATA, "2 poses", "3 videos");
    put_poses(3, 2);
    put_text("cam02.mp4", "");
    expect_bad(ADCGS_ERR_DATA, "cam02.mp4", "");
}

/* ---- COLMAP ---- */

static void put_images(int n, const char *place, const char *end)
{
    put_folder(place);
    for (int i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/%02d.%s", place, i, end);
        put_picture(name, i, RIG_WIDTH, RIG_HEIGHT);
    }
}

static void expect_rig(int n)
{
    open_good();
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TEST], (n + 7) / 8);
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TRAIN], n - (n + 7) / 8);
    for (int s = 0; s < ADCGS_SPLITS; s++)
        for (uint32_t v = 0; v < scene->n_views[s]; v++)
            expect_pose(&scene->views[s][v], atoi(scene->views[s][v].camera.name), 1.0, 1e-12);
    const adcgs_camera *c = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    assert_true(c->width == RIG_WIDTH && c->fx == RIG_FOCAL && c->cx == 0.5 * RIG_WIDTH && c->cy == 0.5 * RIG_HEIGHT);
    assert_int_equal(scene->points.n, count_kept_points(n, 8));
    for (int i = 0, at = 0; i < RIG_POINTS; i++) {
        double x[3];
        if (!(i % n % 8) || !((i + 1) % n % 8))
            continue;
        rig_point(i, x);
        for (int a = 0; a < 3; a++)
            if (scene->points.position[at][a] != (double)(float)x[a])
                fail_msg("point %d: %.17g, expected %.17g", i, scene->points.position[at][a], x[a]);
        assert_true(scene->points.colour[at][0] == i * 9 && scene->points.colour[at][1] == 128);
        at++;
    }
}

static void test_colmap(void **state)
{
    put_images(10, "images", "ppm");
    put_folder("sparse");
    put_folder("sparse/0");
    put_model_binary("sparse/0", 10, "%02d.ppm");
    expect_rig(10);
    assert_int_equal(rename(in("images"), in("input")), 0);
    assert_int_equal(rename(in("sparse/0"), in("elsewhere")), 0);
    put_model_text("sparse", 10, "%02d.JPG", "# cameras\n\n7 PINHOLE 96 64 80 80 48 32\r\n"); /* other line ends, small images */
    expect_rig(10);
    unlink(in("sparse/images.txt"));
    expect_bad(ADCGS_ERR_DATA, "sparse/images.txt: no such file", "");
}

/** Parameters of every kind of camera arrive in the right fields. */
static void test_kinds_of_cameras(void **state)
{
    static const struct {
        const char *line;
        double fy, k[6], p[2];
        int is_fisheye;
    } good[] = {{"SIMPLE_PINHOLE 24 16 20 12 8", 20, {0}, {0}, 0},
                {"PINHOLE 24 16 20 21 12 8", 21, {0}, {0}, 0},
                {"SIMPLE_RADIAL 24 16 20 12 8 0.05", 20, {0.05}, {0}, 0},
                {"RADIAL 24 16 20 12 8 0.05 0.02", 20, {0.05, 0.02}, {0}, 0},
                {"OPENCV 24 16 20 21 12 8 0.05 0.02 0.003 0.004", 21, {0.05, 0.02}, {0.003, 0.004}, 0},
                {"FULL_OPENCV 24 16 20 21 12 8 0.05 0.02 0.003 0.004 0.01 0.011 0.012 0.013",
                 21,
                 {0.05, 0.02, 0.01, 0.011, 0.012, 0.013},
                 {0.003, 0.004},
                 0},
                {"OPENCV_FISHEYE 24 16 20 21 12 8 0.05 0.02 0.003 0.004", 21, {0.05, 0.02, 0.003, 0.004}, {0}, 1},
                {"SIMPLE_RADIAL_FISHEYE 24 16 20 12 8 0.05", 20, {0.05}, {0}, 1},
                {"RADIAL_FISHEYE 24 16 20 12 8 0.05 0.02", 20, {0.05, 0.02}, {0}, 1}};
    static const char *const refused[] = {"FOV", "THIN_PRISM_FISHEYE", "RAD_TAN_THIN_PRISM_FISHEYE"};
    char line[256];
    put_images(2, "images", "ppm");
    put_folder("sparse");
    for (size_t i = 0; i < ADCGS_COUNTOF(good); i++) {
        snprintf(line, sizeof line, "7 %s\n", good[i].line);
        put_model_text("sparse", 2, "%02d.ppm", line);
        open_good();
        const adcgs_scene_view *v = &scene->views[ADCGS_SPLIT_TRAIN][0];
        if (good[i].k[0] == 0.0) {
            assert_true(v->lens.width == 0 && v->camera.fx == 20 && v->camera.fy == good[i].fy && v->camera.cx == 12);
            continue;
        }
        assert_true(v->lens.width == 24 && v->lens.height == 16 && v->lens.fx == 20 && v->lens.fy == good[i].fy);
        assert_true(v->lens.cx == 12 && v->lens.cy == 8 && v->lens.is_fisheye == good[i].is_fisheye);
        assert_memory_equal(v->lens.k, good[i].k, sizeof v->lens.k);
        assert_memory_equal(v->lens.p, good[i].p, sizeof v->lens.p);
    }
    for (size_t i = 0; i < ADCGS_COUNTOF(refused); i++) {
        snprintf(line, sizeof line, "7 %s 24 16 20 20 12 8 0 0 0 0\n", refused[i]);
        put_model_text("sparse", 2, "%02d.ppm", line);
        expect_bad(ADCGS_ERR_UNSUPPORTED, "cameras.txt: line 1", refused[i]);
    }
}

static void bad_line(const char *file, const char *text, const char *what)
{
    char path[64];
    put_model_text("sparse", 2, "%02d.ppm", "7 PINHOLE 24 16 20 20 12 8\n");
    snprintf(path, sizeof path, "sparse/%s", file);
    put_text(path, text);
    expect_bad(ADCGS_ERR_DATA, file, what);
}

static void test_bad_text(void **state)
{
    put_images(2, "images", "ppm");
    put_folder("sparse");
    put_model_text("sparse", 2, "%02d.ppm", "");
    expect_bad(ADCGS_ERR_DATA, "cameras.txt", "no cameras");
    bad_line("cameras.txt", "7 PINHOLE 24 16 20 20 12\n8", "line 1: PARAMS: expected 4 numbers");
    bad_line("cameras.txt", "7 PINHOLE 24 16 20 20 12 8 9\n", "unexpected \"9\"");
    bad_line("cameras.txt", "7 PINHOLE 24 0 20 20 12 8\n", "24x0 pixels");
    bad_line("cameras.txt", "7 PINHOLE 24 16 0 20 12 8\n", "focal lengths 0");
    bad_line("cameras.txt", "7 PINHOLE 24 16 nan 20 12 8\n", "parameter 1");
    bad_line("cameras.txt", "-7 PINHOLE 24 16 20 20 12 8\n", "CAMERA_ID");
    bad_line("cameras.txt", "7 PINHOLE 24 16 20 20 12 8\n7 PINHOLE 24 16 20 20 12 8\n", "camera 7 is listed twice");
    bad_line("images.txt", "1 1 0 0 0 0 0 0 7 00.ppm\n", "1 image, expected at least two");
    bad_line("images.txt", "1 1 0 0 0 0 0 0 7 00.ppm\n\n2 1 0 0 0 0 0 0 8 01.ppm\n\n", "01.ppm: there is no camera 8");
    bad_line("images.txt", "1 1 0 0 0 0 0 0 7 00.ppm\n\n2 1 0 0 0 0 0 0 7 00.ppm\n\n", "00.ppm is listed twice");
    bad_line("images.txt", "1 1 0 0 0 0 0 0 7 ../00.ppm\n", "expected the name of an image below the folder");
    bad_line("images.txt", "1 1 0 0 0 0 0 0 7 /etc/passwd\n", "expected the name of an image below the folder");
    bad_line("images.txt", "1 1 0 0 0 0 0 0 7\n", "expected the name");
    bad_line("images.txt", "1 0 0 0 0 0 0 0 7 00.ppm\n", "no rotation");
    bad_line("images.txt", "1 1 0 0 0 nan 0 0 7 00.ppm\n", "no rotation");
    bad_line("points3D.txt", "1 0 0\n0 1 1 1 0\n", "line 1: X, Y, Z");
    bad_line("points3D.txt", "1 0 0 inf 1 1 1 0\n", "z is inf");
    bad_line("points3D.txt", "1 0 0 0 1 256 1 0\n", "R, G, B");
    bad_line("points3D.txt", "1 0 0 0 1 1 1 0 5\n", "TRACK");
    put_model_text("sparse", 3, "%02d.ppm", "7 PINHOLE 24 16 20 20 12 8\n");
    expect_bad(ADCGS_ERR_DATA, "02.ppm", "no such image");
}

/** Counts and sizes beyond the end of the file; every file cut short anywhere. */
static void test_bad_binary(void **state)
{
    static const char *const files[] = {"sparse/cameras.bin", "sparse/images.bin", "sparse/points3D.bin"};
    static uint8_t data[8192];
    put_images(2, "images", "ppm");
    put_folder("sparse");
    for (int f = 0; f < 3; f++) {
        put_model_binary("sparse", 2, "%02d.ppm");
        FILE *file = fopen(in(files[f]), "rb");
        const size_t size = fread(data, 1, sizeof data, file);
        fclose(file);
        for (size_t n = 0; n < size; n += n < 200 ? 1 : 37) {
            put_bytes(files[f], data, n);
            expect_bad(ADCGS_ERR_DATA, files[f], "");
        }
        adcgs_store_le64(data, UINT64_MAX / 3);
        put_bytes(files[f], data, size);
        expect_bad(ADCGS_ERR_DATA, files[f], "counts 6148914691236517205");
        adcgs_store_le64(data, 0);
        put_bytes(files[f], data, size);
        expect_bad(ADCGS_ERR_DATA, files[f], "bytes after the last");
    }
    put_model_binary("sparse", 2, "%02d.ppm");
    FILE *file = fopen(in(files[2]), "r+b"); /* the first point's track has more entries than there are bytes */
    adcgs_store_le64(data, (uint64_t)1 << 61);
    assert_true(file && !fseek(file, 8 + 43, SEEK_SET) && fwrite(data, 1, 8, file) == 8 && !fclose(file));
    expect_bad(ADCGS_ERR_DATA, "points3D.bin: point 0", "ends early");
    put_model_binary("sparse", 2, "%02d.ppm");
    unlink(in(files[2]));
    expect_bad(ADCGS_ERR_DATA, "points3D.bin: no such file", "");
    const adcgs_scene_options own = {.points_path = in("own.ply")};
    put_text("own.ply", RIG_PLY);
    expect_good(adcgs_scene_open(&scene, folder, &own, &error)); /* points given by the user take its place */
    assert_true(scene->points.n == 1);
}

static void test_colmap_videos(void **state)
{
    put_folder("sparse");
    put_model_binary("sparse", 3, "%02d.png");
    put_folder("videos");
    if (!put_video("videos/00.mp4", 0, 4, RIG_WIDTH, RIG_HEIGHT)) {
        print_message("skipped: this build writes no videos\n");
        skip();
    }
    expect_bad(ADCGS_ERR_DATA, "there is a video of 00.png", "none of 01.png");
    put_video("videos/01.png.mp4", 1, 4, RIG_WIDTH, RIG_HEIGHT);
    put_video("02.mp4", 2, 3, RIG_WIDTH, RIG_HEIGHT);
    expect_bad(ADCGS_ERR_DATA, "video of 00.png has 4 frames", "02.png has 3");
    put_video("02.mp4", 2, 4, RIG_WIDTH, RIG_HEIGHT);
    open_good();
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 8 && scene->n_views[ADCGS_SPLIT_TEST] == 4 && scene->n_times == 4);
    assert_string_equal(scene->views[ADCGS_SPLIT_TEST][0].camera.name, "00");
    expect_pose(&scene->views[ADCGS_SPLIT_TRAIN][7], 2, 1.0, 1e-12);
    assert_true(fabs(scene->views[ADCGS_SPLIT_TRAIN][7].time - 3 / 25.0) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_llff, clean),
        cmocka_unit_test_teardown(test_llff_points, clean),
        cmocka_unit_test_teardown(test_bad_poses, clean),
        cmocka_unit_test_teardown(test_bad_files, clean),
        cmocka_unit_test_teardown(test_neu3d, clean),
        cmocka_unit_test_teardown(test_colmap, clean),
        cmocka_unit_test_teardown(test_kinds_of_cameras, clean),
        cmocka_unit_test_teardown(test_bad_text, clean),
        cmocka_unit_test_teardown(test_bad_binary, clean),
        cmocka_unit_test_teardown(test_colmap_videos, clean),
    };
    int failed = cmocka_run_group_tests(tests, make_folder, remove_folder);
    failed += adcgs_test_rigs_real();
    return failed;
}
