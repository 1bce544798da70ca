/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The layout of Dynamic 3D Gaussians' Panoptic benchmark, arrays in NPZ files, and captures that are not supported. */
#include "layout_files.h"
#include "opened_scene.h"

#include "media/arrays/npz.h"
#include "system/zip.h"

enum { T = 4, TRAIN = 3 };

/** One field of a file: rows by frame and camera, of the rig's cameras first, first + 1, ... */
static size_t put_field(char *text, const char *field, int moments, int first, int n)
{
    size_t at = (size_t)sprintf(text, ",\"%s\":[", field);
    for (int t = 0; t < moments; t++) {
        at += (size_t)sprintf(text + at, "%s[", t ? "," : "");
        for (int c = first; c < first + n; c++) {
            double pose[12];
            rig_pose(c, pose);
            at += (size_t)sprintf(text + at, "%s", c > first ? "," : "");
            if (*field == 'f')
                at += (size_t)sprintf(text + at, "\"%d/%06d.jpg\"", c, t);
            else if (*field == 'c')
                at += (size_t)sprintf(text + at, "%d", c);
            else if (*field == 'k')
                at += (size_t)sprintf(text + at, "[[20,0,12.5],[0,21,8],[0,0,1]]");
            else { /* the world to the camera */
                at += (size_t)sprintf(text + at, "[");
                for (int i = 0; i < 3; i++)
                    at += (size_t)sprintf(text + at, "[%.17g,%.17g,%.17g,%.17g],", pose[i], pose[4 + i], pose[8 + i],
                                          -(pose[i] * pose[3] + pose[4 + i] * pose[7] + pose[8 + i] * pose[11]));
                at += (size_t)sprintf(text + at, "[0,0,0,1]]");
            }
        }
        at += (size_t)sprintf(text + at, "]");
    }
    return at + (size_t)sprintf(text + at, "]");
}

static void put_meta(const char *name, int moments, int first, int n)
{
    static const char *const fields[] = {"fn", "k", "w2c", "cam_id"};
    char *text = malloc(65536);
    assert_non_null(text);
    size_t at = (size_t)sprintf(text, "{\"w\":24,\"h\":16");
    for (size_t i = 0; i < ADCGS_COUNTOF(fields); i++)
        at += put_field(text + at, fields[i], moments, first, n);
    sprintf(text + at, "}");
    put_text(name, text);
    free(text);
}

static void put_points(void)
{
    static uint8_t data[128 + RIG_POINTS * 56];
    char header[128];
    const int n = snprintf(header, sizeof header, "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 7), }", RIG_POINTS);
    memset(data, ' ', 128);
    memcpy(data, "\x93NUMPY\1\0\x76\0", 10);
    memcpy(data + 10, header, (size_t)n);
    data[127] = '\n';
    for (int i = 0; i < RIG_POINTS; i++) {
        double row[7] = {0, 0, 0, 1, 0.5, 0, 1};
        rig_point(i, row);
        for (int k = 0; k < 7; k++)
            adcgs_store_le64(data + 128 + 56 * i + 8 * k, adcgs_double_bits(row[k]));
    }
    adcgs_zip zip = {.file = fopen(in("init_pt_cld.npz"), "wb")};
    assert_non_null(zip.file);
    adcgs_zip_add(&zip, "other.npy", data, 100);
    adcgs_zip_add(&zip, "data.npy", data, sizeof data);
    adcgs_zip_end(&zip);
    fclose(zip.file);
}

static void put_all(void)
{
    put_folder("ims");
    put_folder("seg");
    for (int c = 0; c <= TRAIN; c++) {
        char name[64];
        snprintf(name, sizeof name, "ims/%d", c);
        put_folder(name);
        snprintf(name, sizeof name, "seg/%d", c);
        put_folder(name);
        for (int t = 0; t < T; t++) {
            snprintf(name, sizeof name, "ims/%d/%06d.ppm", c, t);
            put_picture(name, c * T + t, RIG_WIDTH, RIG_HEIGHT);
            char jpeg[64];
            snprintf(jpeg, sizeof jpeg, "ims/%d/%06d.jpg", c, t);
            assert_int_equal(rename(in(name), in(jpeg)), 0); /* detected by content */
            snprintf(name, sizeof name, "seg/%d/%06d.png", c, t);
            put_picture(name, c * T + t, RIG_WIDTH, RIG_HEIGHT);
        }
    }
    put_meta("train_meta.json", T, 0, TRAIN);
    put_meta("test_meta.json", T, TRAIN, 1);
    put_points();
}

static void expect_scene(void)
{
    const adcgs_scene_view *train = scene->views[ADCGS_SPLIT_TRAIN], *test = scene->views[ADCGS_SPLIT_TEST];
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == TRAIN * T && scene->n_views[ADCGS_SPLIT_TEST] == T && scene->n_times == T);
    assert_true(fabs(scene->duration - (T - 1) / 30.0) < 1e-12);
    for (int t = 0; t < T; t++) {
        for (int c = 0; c < TRAIN; c++) {
            expect_pose(&train[t * TRAIN + c], c, 1.0, 1e-12);
            assert_true(fabs(train[t * TRAIN + c].time - t / 30.0) < 1e-12 && train[t * TRAIN + c].camera.name[0] == '0' + c);
        }
        expect_pose(&test[t], TRAIN, 1.0, 1e-12);
    }
    assert_true(train[0].camera.fx == 20.0 && train[0].camera.fy == 21.0 && train[0].camera.cx == 12.5);
    assert_true(train[4].moving && strstr(train[4].moving, "seg/1/000001.png") && strstr(train[4].path, "ims/1/000001.jpg"));
    assert_int_equal(scene->points.n, RIG_POINTS);
    assert_true(scene->points.coloured && scene->points.colour[3][0] == 255 && scene->points.colour[3][1] == 128);
    for (int i = 0; i < RIG_POINTS; i++) {
        double x[3];
        rig_point(i, x);
        assert_true(fabs(scene->points.position[i][1] - x[1]) < 1e-7);
    }
}

static void test_good(void **state)
{
    put_all();
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    expect_scene();
    adcgs_scene_free(&scene);
    assert_int_equal(rename(in("ims/1/000001.jpg"), in("ims/1/000001.JPG")), 0); /* another letter case */
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    assert_int_equal(rename(in("ims/1/000001.JPG"), in("ims/1/000001.jpg")), 0);
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, in("train_meta.json"), NULL, &error));
    expect_scene();
    adcgs_scene_free(&scene);
    const adcgs_scene_options some = {.frames = {1, 3, 1}, .dataset = ADCGS_DATASET_PANOPTIC};
    expect_good(adcgs_scene_open(&scene, folder, &some, &error));
    assert_true(scene->n_times == 2 && scene->n_views[ADCGS_SPLIT_TEST] == 2);
    adcgs_scene_free(&scene);
    expect_error(adcgs_scene_open(&scene, in("test_meta.json"), NULL, &error), ADCGS_ERR_USAGE, "test_meta.json",
                 "train_meta.json");
}

/** Writes a file with one text replaced. */
static void replace(const char *name, const char *from, const char *to)
{
    char *text = malloc(65536), *made = malloc(65536);
    assert_true(text && made);
    FILE *file = fopen(in(name), "rb");
    const size_t n = fread(text, 1, 65535, file);
    fclose(file);
    text[n] = 0;
    char *at = strstr(text, from);
    assert_non_null(at);
    snprintf(made, 65536, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    put_text(name, made);
    free(text);
    free(made);
}

static void test_bad(void **state)
{
    static const struct {
        const char *file, *from, *to, *first, *second;
    } cases[] = {
        {"train_meta.json", "\"w\":24,\"h\":16,", "", "train_meta.json: w", "missing"},
        {"train_meta.json", "\"w\":24", "\"w\":30", "ims/0/000000.jpg: 24x16", "30x16"},
        {"train_meta.json", "[[20,0,12.5]", "[[20,0]", "k[0][0]", "3 rows of 3"},
        {"train_meta.json", "[0,0,1]]", "[0,1,1]]", "k[0][0]", "[0, 0, 1]"},
        {"train_meta.json", "[0,0,0,1]]", "[0,0,0,1]", "malformed", "line 1"},
        {"train_meta.json", "\"1/000000.jpg\"", "7", "fn[0][1]", "name of an image"},
        {"train_meta.json", "\"1/000000.jpg\"", "\"../1/000000.jpg\"", "fn[0][1]", "name of an image"},
        {"train_meta.json", "\"1/000000.jpg\"", "\"1/000009.jpg\"", "fn[0][1]", "no such image"},
        {"train_meta.json", "\"1/000000.jpg\",", "", "k[0]: 3 cameras", "as many as fn"},
        {"train_meta.json", "\"fn\"", "\"nf\"", "fn: 0 timestamps", ""},
        {"test_meta.json", "\"3/000001.jpg\"", "\"1/000001.jpg\"", "test_meta.json: fn[1][0]", "is for training, too"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        put_all();
        replace(cases[i].file, cases[i].from, cases[i].to);
        expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, cases[i].first, cases[i].second);
    }
    put_all();
    put_meta("test_meta.json", T + 1, TRAIN, 1);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "test_meta.json: fn: 5 timestamps",
                 "4 of train");
}

/** Archives that end early or contradict themselves; and one that numpy has deflated. */
static void test_npz(void **state)
{
    static uint8_t whole[8192];
    uint8_t *data;
    size_t bytes, n;
    put_points();
    FILE *file = fopen(in("init_pt_cld.npz"), "rb");
    n = fread(whole, 1, sizeof whole, file);
    fclose(file);
    assert_true(n > 1000 && n < sizeof whole);
    expect_good(adcgs_npz_read(&data, &bytes, in("init_pt_cld.npz"), "data", &error));
    assert_int_equal(bytes, 128 + RIG_POINTS * 56);
    free(data);
    expect_error(adcgs_npz_read(&data, &bytes, in("init_pt_cld.npz"), "dat", &error), ADCGS_ERR_DATA, "no array dat",
                 "init_pt_cld");
    for (size_t cut = 0; cut < n; cut += 7) {
        put_bytes("cut.npz", whole, cut);
        assert_int_not_equal(adcgs_npz_read(&data, &bytes, in("cut.npz"), "data", &error), ADCGS_OK);
        assert_null(data);
    }
    for (size_t i = n - 150; i < n; i++) { /* one byte of the directory at a time changed: any outcome but a crash */
        const uint8_t before = whole[i];
        for (int v = 0; v < 256; v += 51) {
            whole[i] = (uint8_t)v;
            put_bytes("odd.npz", whole, n);
            if (adcgs_npz_read(&data, &bytes, in("odd.npz"), "data", &error) == ADCGS_OK)
                free(data);
        }
        whole[i] = before;
    }
    expect_good(adcgs_npz_read(&data, &bytes, real_data("splats4d/dynamic3dgaussians/params.npz"), "log_scales", &error));
    assert_true(bytes == 20528 && !memcmp(data, "\x93NUMPY", 6));
    free(data);
}

/** A known format without support is named. */
static void test_record3d(void **state)
{
    static const char capture[] = "{\"w\":960,\"h\":720,\"fps\":60,\"K\":[1,0,0,0,1,0,0,0,1],\"poses\":[[0,0,0,1,0,0,0]]}";
    put_text("metadata.json", capture);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_UNSUPPORTED, "metadata.json", "Record3D");
    expect_error(adcgs_scene_open(&scene, in("metadata.json"), NULL, &error), ADCGS_ERR_UNSUPPORTED, "Record3D",
                 "ns-process-data");
    unlink(in("metadata.json"));
    put_folder("EXR_RGBD");
    put_text("EXR_RGBD/metadata", capture);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_UNSUPPORTED, "EXR_RGBD/metadata", "Record3D");
}

/** Folders of other programs are recognised by their files; the message advises. A folder above a scene is refused, too. */
static void test_other_folders(void **state)
{
    static const char *const cases[][4] = {
        {"cfg_args", "point_cloud", "output of 3D Gaussian splatting", "give its point_cloud/iteration_N"},
        {"intri.yml", "extri.yml", "EasyMocap", "COLMAP"},
        {"annots.npy", "images", "ZJU-MoCap", "COLMAP"},
        {"intrinsics.txt", "pose", "NSVF", "COLMAP"},
        {"cameras_sphere.npz", "image", "NeuS", "COLMAP"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        put_folder("x");
        char name[64];
        for (int k = 0; k < 2; k++) {
            snprintf(name, sizeof name, "x/%s", cases[i][k]);
            put_text(name, "-");
        }
        put_text("x/input.ply", RIG_PLY);
        expect_error(adcgs_scene_open(&scene, in("x"), NULL, &error), ADCGS_ERR_UNSUPPORTED, cases[i][2], cases[i][3]);
        for (int k = 0; k < 2; k++) {
            snprintf(name, sizeof name, "x/%s", cases[i][k]);
            assert_int_equal(remove(in(name)), 0);
        }
        assert_int_equal(remove(in("x/input.ply")), 0);
    }
    put_text("x/transforms.json", "{}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, ": not a scene, but its folder x is one", "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_good, clean),          cmocka_unit_test_teardown(test_bad, clean),
        cmocka_unit_test_teardown(test_npz, clean),           cmocka_unit_test_teardown(test_record3d, clean),
        cmocka_unit_test_teardown(test_other_folders, clean),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
