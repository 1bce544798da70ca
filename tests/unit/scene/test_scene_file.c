/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The adcgs scene file: every field, every kind of bad input, and a real calibration where available. */
#include "layout_files.h"

#include "scene/layouts/open.h"

#include <jansson.h>

static adcgs_scene *scene;

static void expect_good(adcgs_status status)
{
    if (status != ADCGS_OK)
        fail_msg("%s", error.text);
}

static int setup(void **state)
{
    if (make_folder(state) || mkdir(in("a"), 0777))
        return -1;
    for (int i = 1; i <= 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "a/f%03d.ppm", i);
        put_picture(name, i, RIG_WIDTH, RIG_HEIGHT);
    }
    return 0;
}

static int close_it(void **state)
{
    adcgs_scene_free(&scene);
    return 0;
}

static void open_good(const char *text)
{
    adcgs_scene_free(&scene);
    put_text("s.json", text);
    expect_good(adcgs_scene_open(&scene, in("s.json"), NULL, &error));
}

#define IDENTITY "\"camera_to_world\":[[1,0,0,1],[0,1,0,2],[0,0,1,3]]"
#define SIZE "\"width\":24,\"height\":16,\"fx\":20"
#define FOOTAGE "\"images\":\"a/f%03d.ppm\",\"first\":1"
#define CAMERA(more) "{\"name\":\"a\"," SIZE "," FOOTAGE more "}"
#define FILE_OF(root, cameras) "{\"adcgs_scene\":1" root ",\"cameras\":[" cameras "]}"

#define MATRIX_R "\"R\":[[%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g]],\"t\":"

static const adcgs_scene_view *train(uint32_t i)
{
    assert_true(i < scene->n_views[ADCGS_SPLIT_TRAIN]);
    return &scene->views[ADCGS_SPLIT_TRAIN][i];
}

/** A pose in each supported form. */
static void test_poses(void **state)
{
    for (int i = 0; i < 5; i++)
        for (int way = 0; way < 6; way++) {
            double pose[12], inverse[12];
            char text[2048], how[1024];
            rig_pose(i, pose);
            for (int a = 0; a < 3; a++) {
                for (int b = 0; b < 3; b++)
                    inverse[4 * a + b] = pose[4 * b + a];
                inverse[4 * a + 3] = -(pose[a] * pose[3] + pose[4 + a] * pose[7] + pose[8 + a] * pose[11]);
            }
            double gl[12]; /* world to camera in OpenGL axes: rows of y and z are inverted */
            for (int k = 0; k < 12; k++)
                gl[k] = k < 4 ? inverse[k] : -inverse[k];
            const double *v = inverse;
            if (way == 0)
                snprintf(how, sizeof how, "\"camera_to_world\":%s", json_matrix(pose));
            else if (way == 1)
                snprintf(how, sizeof how, "\"camera_to_world\":%s,\"axes\":\"opengl\"", json_opengl(pose));
            else if (way == 2)
                snprintf(how, sizeof how, "\"world_to_camera\":%s", json_matrix(inverse));
            else if (way == 3)
                snprintf(how, sizeof how, "\"world_to_camera\":%s,\"axes\":\"opengl\"", json_matrix(gl));
            else
                snprintf(how, sizeof how, way == 4 ? MATRIX_R "[%.17g,%.17g,%.17g]" : MATRIX_R "[[%.17g],[%.17g],[%.17g]]", v[0],
                         v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10], v[3], v[7], v[11]);
            snprintf(text, sizeof text,
                     "{\"adcgs_scene\":1,\"scale\":0.001,\"cameras\":[{\"name\":\"a\"," SIZE ",\"images\":\"a/f001.ppm\",%s}]}",
                     how);
            open_good(text);
            expect_pose(train(0), i, 0.001, 1e-14);
        }
}

static void test_intrinsics(void **state)
{
    open_good(FILE_OF("", CAMERA("," IDENTITY)));
    const adcgs_camera *c = &train(0)->camera;
    assert_true(c->fx == 20 && c->fy == 20 && c->cx == 12 && c->cy == 8 && c->width == 24 && c->height == 16);
    open_good(FILE_OF(",\"defaults\":{\"pixel_centre\":0,\"fy\":21}", CAMERA("," IDENTITY ",\"cx\":11,\"cy\":7")));
    c = &train(0)->camera;
    assert_true(c->fx == 20 && c->fy == 21 && c->cx == 11.5 && c->cy == 7.5 && train(0)->lens.width == 0);
    /* A camera for 48x32, centres at integers: (11 + 0.5) / 2. */
    open_good(
        FILE_OF("",
                "{\"name\":\"a\",\"width\":48,\"height\":32,\"fx\":40,\"fy\":42,\"cx\":11,\"cy\":15,\"pixel_centre\":0," FOOTAGE
                "," IDENTITY "}"));
    c = &train(0)->camera;
    assert_true(c->fx == 20 && c->fy == 21 && c->cx == 5.75 && c->cy == 7.75);
    open_good(FILE_OF("", CAMERA("," IDENTITY ",\"k1\":0.01,\"k2\":0.02,\"k3\":0.03,\"k4\":0.04,\"k5\":0.05,\"k6\":0.06,"
                                 "\"p1\":0.007,\"p2\":0.008,\"skew\":0.5")));
    const adcgs_lens *l = &train(0)->lens;
    for (int i = 0; i < 6; i++)
        assert_true(l->k[i] == (i + 1) / 100.0);
    assert_true(l->p[0] == 0.007 && l->p[1] == 0.008 && l->skew == 0.5 && l->width == 24 && !l->is_fisheye);
    open_good(FILE_OF(",\"defaults\":{\"lens\":\"fisheye\",\"k1\":0.01,\"k4\":0.04}", CAMERA("," IDENTITY ",\"k2\":0.02")));
    l = &train(0)->lens;
    assert_true(l->is_fisheye && l->k[0] == 0.01 && l->k[1] == 0.02 && l->k[2] == 0 && l->k[3] == 0.04 && l->width == 24);
}

/** Seconds: offsets, different rates, and test frames before and after the trained times. */
static void test_times(void **state)
{
    open_good(FILE_OF(",\"frame_rate\":10,\"unit\":\"metre\",\"up\":\"z\",\"name\":\"times\"",
                      CAMERA(",\"count\":3,\"time_offset\":2," IDENTITY) ","
                                                                         "{\"name\":\"b\"," SIZE "," FOOTAGE "," IDENTITY
                                                                         ",\"frame_rate\":20,\"time_offset\":1.95,"
                                                                         "\"split\":\"test\"},"
                                                                         "{\"name\":\"c\"," SIZE
                                                                         ",\"images\":\"a/f002.ppm\"," IDENTITY
                                                                         ",\"time_offset\":2.1,\"split\":\"val\"}"));
    assert_true(scene->units == 1 && scene->axes == ADCGS_AXES_Z_UP && adcgs_fps_value(scene->rate) == 10 && scene->n_times == 3);
    assert_true(fabs(scene->duration - 0.2) < 1e-12 && scene->n_views[ADCGS_SPLIT_TRAIN] == 3);
    for (uint32_t i = 0; i < 3; i++)
        assert_true(fabs(train(i)->time - 0.1 * i) < 1e-12);
    assert_int_equal(scene->n_views[ADCGS_SPLIT_TEST], 3); /* of 1.95, 2, 2.05, 2.1 the first is too early */
    for (uint32_t i = 0; i < 3; i++)
        assert_true(fabs(scene->views[ADCGS_SPLIT_TEST][i].time - 0.05 * i) < 1e-12);
    assert_true(scene->n_views[ADCGS_SPLIT_VAL] == 1 && fabs(scene->views[ADCGS_SPLIT_VAL][0].time - 0.1) < 1e-12);
    assert_string_equal(scene->views[ADCGS_SPLIT_VAL][0].camera.name, "c");
    /* The stream's rate changes nothing: these times are seconds already. */
    const adcgs_scene_options options = {.rate = {7, 1}, .frames = {1, 0, 1}};
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, in("s.json"), &options, &error) == ADCGS_ERR_DATA ? ADCGS_OK : ADCGS_ERR_DATA);
    put_text("s.json", FILE_OF(",\"frame_rate\":10", CAMERA("," IDENTITY)));
    expect_good(adcgs_scene_open(&scene, in("s.json"), &options, &error));
    assert_true(adcgs_fps_value(scene->rate) == 7 && fabs(scene->duration - 0.2) < 1e-12 && train(0)->time == 0.0);
    assert_non_null(strstr(train(0)->path, "f002.ppm"));
}

static void test_points(void **state)
{
    put_text("p.ply", RIG_PLY);
    put_text("points3d.ply", "not looked at");
    open_good(FILE_OF("", CAMERA("," IDENTITY)));
    assert_int_equal(scene->points.n, 0);
    open_good(FILE_OF(",\"scale\":0.5,\"points\":\"p.ply\"", CAMERA("," IDENTITY)));
    assert_true(scene->points.position[0][2] == 1.5 && train(0)->camera.cam_to_world[3] == 0.5);
    open_good(FILE_OF(",\"scale\":0.5,\"points\":\"p.ply\",\"points_scale\":1", CAMERA("," IDENTITY)));
    assert_true(scene->points.position[0][2] == 3.0);
}

/** Players use the sound: its file need not exist. Its time counts from the first training view. */
static void test_sound(void **state)
{
    open_good(FILE_OF("", CAMERA("," IDENTITY)));
    assert_null(scene->sound);
    open_good(FILE_OF(",\"sound\":\"s.opus\",\"sound_offset\":0.2", CAMERA(",\"time_offset\":0.5," IDENTITY)));
    assert_string_equal(scene->sound, in("s.opus"));
    assert_true(fabs(scene->sound_begin + 0.3) < 1e-12);
}

static void expect_bad(const char *text, const char *what)
{
    put_text("s.json", text);
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, "s.json", what);
}

#define BAD_CAMERA(more, what) expect_bad(FILE_OF("", CAMERA(more)), "cameras[0]." what)

static void test_bad(void **state)
{
    put_text("s.json", "{\"adcgs_scene\":2}");
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_UNSUPPORTED, "adcgs_scene",
                 "expected version 1");
    expect_bad("{\"adcgs_scene\":\"1\"}", "adcgs_scene: expected version 1");
    expect_bad("{\"adcgs_scene\":1}", "cameras: expected an array");
    expect_bad("{\"adcgs_scene\":1,\"cameras\":[]}", "cameras: expected an array");
    expect_bad("{\"adcgs_scene\":1,\"cameras\":[7]}", "cameras[0]: expected an object");
    expect_bad("{\"adcgs_scene\":1,\"camera\":[]}", "camera: unknown field");
    expect_bad(FILE_OF(",\"defaults\":{\"fz\":1}", CAMERA("," IDENTITY)), "defaults.fz: unknown field");
    expect_bad(FILE_OF(",\"defaults\":{\"name\":\"x\"}", CAMERA("," IDENTITY)), "defaults.name: unknown field");
    expect_bad(FILE_OF(",\"defaults\":[]", CAMERA("," IDENTITY)), "defaults: expected an object");
    expect_bad(FILE_OF(",\"unit\":\"inch\"", CAMERA("," IDENTITY)), "unit: inch");
    expect_bad(FILE_OF(",\"sound\":7", CAMERA("," IDENTITY)), "sound: expected a text");
    expect_bad(FILE_OF(",\"sound\":\"/etc/s.opus\"", CAMERA("," IDENTITY)), "sound: /etc/s.opus, expected the name");
    expect_bad(FILE_OF(",\"sound\":\"../s.opus\"", CAMERA("," IDENTITY)), "sound: ../s.opus");
    expect_bad(FILE_OF(",\"sound_offset\":1", CAMERA("," IDENTITY)), "sound_offset: expected a sound");
    expect_bad(FILE_OF(",\"sound\":\"s\",\"sound_offset\":1e7", CAMERA("," IDENTITY)), "sound_offset: 1e+07");
    expect_bad(FILE_OF(",\"up\":\"x\"", CAMERA("," IDENTITY)), "up: x");
    expect_bad(FILE_OF(",\"scale\":0", CAMERA("," IDENTITY)), "scale: 0");
    expect_bad(FILE_OF("", CAMERA("," IDENTITY) "," CAMERA("," IDENTITY)), "cameras[1].name: a is used twice");
    expect_bad(FILE_OF("", CAMERA("," IDENTITY ",\"split\":\"test\"")), "cameras: none is for training");
    BAD_CAMERA(",\"fxy\":1," IDENTITY, "fxy: unknown field");
    BAD_CAMERA(",\"split\":\"dev\"," IDENTITY, "split: dev");
    BAD_CAMERA(",\"axes\":\"maya\"," IDENTITY, "axes: maya");
    BAD_CAMERA(",\"pixel_centre\":0.25," IDENTITY, "pixel_centre: 0.25");
    BAD_CAMERA(",\"lens\":\"plastic\"," IDENTITY, "lens: plastic");
    BAD_CAMERA(",\"lens\":\"fisheye\",\"p1\":0.1," IDENTITY, "p1: 0.1, but a fisheye lens");
    BAD_CAMERA(",\"lens\":\"fisheye\",\"k5\":0.1," IDENTITY, "k5: 0.1, but a fisheye lens");
    BAD_CAMERA(",\"video\":\"a.mp4\"," IDENTITY, "video: expected either");
    BAD_CAMERA(",\"frame_rate\":0," IDENTITY, "frame_rate: 0");
    BAD_CAMERA(",\"count\":1.5," IDENTITY, "count: 1.5");
    BAD_CAMERA("", "camera_to_world: expected one of");
    BAD_CAMERA("," IDENTITY ",\"t\":[0,0,0]", "camera_to_world: expected one of");
    BAD_CAMERA(",\"R\":[[1,0,0],[0,1,0],[0,0,1]]", "t: expected 3 numbers");
    BAD_CAMERA(",\"R\":[[1,0,0],[0,1,0],[0,0]],\"t\":[0,0,0]", "R: expected rows of 3");
    BAD_CAMERA(",\"camera_to_world\":[[1,0,0,0],[0,1,0,0],[0,0,2,0]]", "camera_to_world: is not orthonormal");
    BAD_CAMERA(",\"world_to_camera\":[[1,0,0,0],[0,1,0,0],[0,0,-1,0]]", "world_to_camera: is a reflection");
    BAD_CAMERA(",\"world_to_camera\":[[1,0,0,1e99],[0,1,0,0],[0,0,1,0]]", "world_to_camera: 1e+99");
    expect_bad(FILE_OF("", "{\"name\":\"a/b\"}"), "cameras[0].video: expected either");
    put_text("s.json", FILE_OF("", CAMERA(",\"lens\":\"fisheye\",\"k1\":-9," IDENTITY)));
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, "f001.ppm", "the lens folds inside");
    put_text("s.json", FILE_OF("", CAMERA(",\"count\":9," IDENTITY)));
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, "a/f005.ppm", "no such image");
}

static void test_bad_footage(void **state)
{
    static const char *const names[] = {"a/f%03s.ppm",  "a/%d%d.ppm", "a/%n.ppm",  "a/f%3d.ppm",
                                        "a/f%099d.ppm", "a/%",        "a/f%*d.ppm"};
    char text[512];
    for (size_t i = 0; i < ADCGS_COUNTOF(names); i++) {
        snprintf(text, sizeof text, FILE_OF("", "{\"name\":\"a\"," SIZE ",\"images\":\"%s\"," IDENTITY "}"), names[i]);
        put_text("s.json", text);
        expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, names[i],
                     "expected the name of an image");
    }
    put_text("s.json", FILE_OF("", "{\"name\":\"a\"," SIZE ",\"images\":\"a/f001.ppm\",\"count\":2," IDENTITY "}"));
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, "a/f001.ppm", "no %d");
    put_text("s.json", FILE_OF("", "{\"name\":\"a\"," SIZE ",\"images\":\"b/%d.ppm\"," IDENTITY "}"));
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, "b/0.ppm", "no such image");
    put_text("s.json", FILE_OF("", "{\"name\":\"a\"," SIZE ",\"video\":\"b.mp4\"," IDENTITY "}"));
    const adcgs_status status = adcgs_scene_open(&scene, in("s.json"), NULL, &error);
    assert_true(status == ADCGS_ERR_IO || status == ADCGS_ERR_UNSUPPORTED);
    put_text("s.json", FILE_OF("", "{\"name\":\"a\",\"width\":16,\"height\":16,\"fx\":9," FOOTAGE "," IDENTITY "}"));
    expect_error(adcgs_scene_open(&scene, in("s.json"), NULL, &error), ADCGS_ERR_DATA, "f001.ppm: 24x16", "16x16");
}

/* ---- A real calibration ---- */

static double number(json_t *matrix, size_t row, size_t column)
{
    return json_number_value(json_array_get(json_array_get(matrix, row), column));
}

/** Rows of a published matrix as text. */
static char *rows_of(json_t *matrix)
{
    return json_dumps(matrix, JSON_COMPACT);
}

/**
 * The published calibration of zju313_15f, put into a scene file unchanged: K for 1024x1024 with pixel centres at integers, R and
 * T in millimetres. Its cameras and times equal those of the transforms files.
 */
static void test_calibration(void **state)
{
    const char *path = real_data("zju313_15f");
    adcgs_scene *other;
    expect_good(adcgs_scene_open(&other, path, NULL, &error));
    char file[1100];
    snprintf(file, sizeof file, "%s/calibration_original.json", path);
    json_t *root = json_load_file(file, 0, NULL), *cams = json_object_get(json_object_get(root, "cams"), "20190823");
    assert_int_equal(json_array_size(json_object_get(cams, "K")), 21);
    FILE *out = fopen(in("zju.json"), "w");
    fprintf(out,
            "{\"adcgs_scene\":1,\"scale\":0.001,\"unit\":\"metre\",\"up\":\"z\",\"points\":\"%s/points3d.ply\","
            "\"points_scale\":1,\"defaults\":{\"width\":1024,\"height\":1024,\"pixel_centre\":0,\"first\":1,\"count\":15},"
            "\"cameras\":[",
            path);
    for (size_t i = 0; i < 21; i++) {
        json_t *k = json_array_get(json_object_get(cams, "K"), i);
        char *r = rows_of(json_array_get(json_object_get(cams, "R"), i));
        char *t = rows_of(json_array_get(json_object_get(cams, "T"), i));
        fprintf(out,
                "%s{\"name\":\"cam%02zu\",\"fx\":%.17g,\"fy\":%.17g,\"cx\":%.17g,\"cy\":%.17g,\"R\":%s,\"t\":%s,"
                "\"images\":\"%s/cam%02zu/frame_%%05d.png\",\"split\":\"%s\"}",
                i ? "," : "", i + 1, number(k, 0, 0), number(k, 1, 1), number(k, 0, 2), number(k, 1, 2), r, t, path, i + 1,
                i == 9 || i == 20  ? "test"
                : i == 1 || i == 6 ? "val"
                                   : "train");
        free(r);
        free(t);
    }
    fprintf(out, "]}");
    fclose(out);
    json_decref(root);
    expect_good(adcgs_scene_open(&scene, in("zju.json"), NULL, &error));
    assert_true(scene->n_times == 15 && fabs(scene->duration - other->duration) < 1e-12 && scene->axes == other->axes);
    assert_int_equal(scene->points.n, 1313);
    assert_memory_equal(scene->points.position, other->points.position, 1313 * sizeof *other->points.position);
    for (int s = 0; s < ADCGS_SPLITS; s++) {
        assert_int_equal(scene->n_views[s], other->n_views[s]);
        uint32_t found = 0;
        for (uint32_t i = 0; i < scene->n_views[s]; i++)
            for (uint32_t j = 0; j < other->n_views[s]; j++) {
                const adcgs_scene_view *v = &scene->views[s][i], *w = &other->views[s][j];
                const char *a = strstr(v->path, "/cam"), *b = strstr(w->path, "/cam");
                if (strcmp(a, b))
                    continue;
                found++;
                assert_true(fabs(v->time - w->time) < 1e-9 && v->camera.width == 512 && v->camera.height == 512);
                assert_true(fabs(v->camera.fx - w->camera.fx) < 1e-9 && fabs(v->camera.fy - w->camera.fy) < 1e-9);
                assert_true(fabs(v->camera.cx - w->camera.cx) < 1e-9 && fabs(v->camera.cy - w->camera.cy) < 1e-9);
                for (int k = 0; k < 12; k++)
                    assert_true(fabs(v->camera.cam_to_world[k] - w->camera.cam_to_world[k]) < 1e-6);
            }
        assert_int_equal(found, scene->n_views[s]);
    }
    adcgs_scene_free(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_poses, close_it),       cmocka_unit_test_teardown(test_intrinsics, close_it),
        cmocka_unit_test_teardown(test_times, close_it),       cmocka_unit_test_teardown(test_points, close_it),
        cmocka_unit_test_teardown(test_sound, close_it),       cmocka_unit_test_teardown(test_bad, close_it),
        cmocka_unit_test_teardown(test_bad_footage, close_it), cmocka_unit_test_teardown(test_calibration, close_it),
    };
    return cmocka_run_group_tests(tests, setup, remove_folder);
}
