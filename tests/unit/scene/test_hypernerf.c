/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Scenes in the layout of HyperNeRF: every field, every kind of bad input. Its second source opens real scenes. */
#include "hypernerf_files.h"
#include "second_sources.h"

#include "scene/layouts/open.h"
#include "scene/scene.h"

#include <math.h>

static void test_fields(void **state)
{
    open_good();
    expect_views(2, 1);
    const adcgs_scene_view *a = &scene->views[ADCGS_SPLIT_TRAIN][0], *b = &scene->views[ADCGS_SPLIT_TEST][0];
    const adcgs_scene_view *c = &scene->views[ADCGS_SPLIT_TRAIN][1];
    assert_string_equal(a->camera.name, "a");
    assert_string_equal(b->camera.name, "b");
    assert_string_equal(c->camera.name, "c");
    assert_true(a->camera.width == 6 && a->camera.height == 4 && a->camera.fx == 8.0 && a->camera.fy == 12.0);
    assert_true(a->camera.cx == 2.5 && a->camera.cy == 2.25 && c->camera.fy == 8.0);
    /* Columns are the camera's axes; the centre is (position - center) * scale. */
    const double expected[12] = {0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 2}, plain[12] = {1, 0, 0, -0.5, 0, 1, 0, 0, 0, 0, 1, -2};
    for (int i = 0; i < 12; i++)
        assert_true(a->camera.cam_to_world[i] == expected[i] && c->camera.cam_to_world[i] == plain[i]);
    /* Times are warp ids, which count frames. The scene ends with the largest of all, in whichever split. */
    assert_true(scene->n_times == 2 && adcgs_fps_value(scene->rate) == 30.0 && scene->duration == 8.0 / 30.0);
    assert_true(a->time == 0.0 && fabs(b->time - 3.0 / 30.0) < 1e-15 && fabs(c->time - 4.0 / 30.0) < 1e-15);
    assert_int_equal(scene->points.n, 2);
    const double points[2][3] = {{0.0, 1.0, 2.0}, {-1.0, 0.0, 0.75}};
    assert_memory_equal(scene->points.position, points, sizeof points);
    float *rgb;
    expect_good(adcgs_scene_image(scene, b, 1, &rgb, NULL, &error));
    free(rgb);
    adcgs_scene_free(&scene);
    const adcgs_scene_options options = {.rate = {10, 1}, .points_path = in("other.npy")};
    put_bytes("other.npy", NPY NUMBERS, sizeof NPY + sizeof NUMBERS - 2);
    put_text("points.npy", "not looked at");
    expect_good(adcgs_scene_open(&scene, folder, &options, &error)); /* points given by the user are in world units already */
    assert_true(scene->duration == 0.8 && scene->points.n == 2 && scene->points.position[0][1] == 2.0);
    adcgs_scene_free(&scene);
}

/** Without a list of val_ids, ids 0, 4, 8, ... are for training and 2, 6, ... for testing. */
static void test_rule(void **state)
{
    put_text("dataset.json", "{\"ids\":[\"a\",\"x\",\"b\",\"x\",\"c\"],\"train_ids\":[\"x\"],\"val_ids\":[]}");
    open_good();
    expect_views(2, 1);
    assert_string_equal(scene->views[ADCGS_SPLIT_TRAIN][1].camera.name, "c");
    assert_string_equal(scene->views[ADCGS_SPLIT_TEST][0].camera.name, "b");
    adcgs_scene_free(&scene);
    put_text("dataset.json", "{\"ids\":[\"c\"]}");
    assert_int_equal(rename(in("rgb/1x/c.png"), in("rgb/1x/C.PNG")), 0); /* another letter case */
    open_good();
    assert_int_equal(rename(in("rgb/1x/C.PNG"), in("rgb/1x/c.png")), 0);
    expect_views(1, 0);
    assert_true(scene->n_times == 1 && scene->duration == 0.0 && scene->views[ADCGS_SPLIT_TRAIN][0].time == 0.0);
    adcgs_scene_free(&scene);
}

/** The largest images are used; if they are at 1/N of full size, cameras are scaled to match. */
static void test_reduced(void **state)
{
    put_text("dataset.json", "{\"train_ids\":[\"c\"],\"val_ids\":[\"b\"]}");
    put_text("camera/b.json", "{" PLAIN ",\"focal_length\":8,\"principal_point\":[9,6],\"image_size\":[17,12]}");
    put_text("camera/c.json", "{" PLAIN ",\"focal_length\":8,\"principal_point\":[9,6],\"image_size\":[17,12]}");
    assert_int_equal(rename(in("rgb/1x"), in("rgb/3x")), 0);
    assert_true(!mkdir(in("rgb/16x"), 0777) && !mkdir(in("rgb/x"), 0777) && !mkdir(in("rgb/0x"), 0777));
    put_text("rgb/2x", "no folder");
    open_good();
    const adcgs_camera *c = &scene->views[ADCGS_SPLIT_TRAIN][0].camera;
    assert_true(c->width == 6 && c->height == 4 && c->fx == 8.0 / 3.0 && c->fy == 8.0 / 3.0 && c->cx == 3.0 && c->cy == 2.0);
    float *rgb;
    expect_good(adcgs_scene_image(scene, &scene->views[ADCGS_SPLIT_TEST][0], 1, &rgb, NULL, &error));
    free(rgb);
    adcgs_scene_free(&scene);
    put_text("camera/b.json", "{" PLAIN ",\"focal_length\":8,\"principal_point\":[9,6],\"image_size\":[17,15]}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "rgb/3x/b.ppm: 6x4", "5.66667x5");
    assert_true(!remove(in("rgb/2x")) && !rmdir(in("rgb/16x")) && !rmdir(in("rgb/x")) && !rmdir(in("rgb/0x")));
    assert_int_equal(rename(in("rgb/3x"), in("rgb/65x")), 0);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, folder, "rgb/1x");
    assert_int_equal(rename(in("rgb/65x"), in("rgb/1x")), 0);
}

/** Points are those of the file, in its order, whether or not a camera sees them. None is valid. */
static void test_points(void **state)
{
    put_text("scene.json", "{\"center\":[0,0,0],\"scale\":1}");
    open_good();
    assert_true(scene->points.n == 2 && scene->points.position[0][2] == 3.0 && scene->points.position[1][0] == -1.0);
    assert_true(scene->points.colour[1][0] == 128);
    adcgs_scene_free(&scene);
    unlink(in("points.npy"));
    open_good();
    assert_int_equal(scene->points.n, 0);
    adcgs_scene_free(&scene);
}

/** Test views change nothing but themselves. */
static void test_apart(void **state)
{
    adcgs_scene *first;
    expect_good(adcgs_scene_open(&first, folder, NULL, &error));
    put_text("camera/b.json", "{\"orientation\":[[0,0,1],[0,-1,0],[1,0,0]],\"position\":[900,8,7],\"focal_length\":1,"
                              "\"principal_point\":[0,0],\"image_size\":[6,4]}");
    put_text("metadata.json", "{\"a\":{\"warp_id\":0},\"b\":{\"warp_id\":7},\"c\":{\"warp_id\":4},\"d\":{\"warp_id\":8}}");
    open_good();
    assert_true(scene->views[ADCGS_SPLIT_TEST][0].camera.fx != first->views[ADCGS_SPLIT_TEST][0].camera.fx);
    for (uint32_t i = 0; i < 2; i++) {
        const adcgs_scene_view *one = &scene->views[ADCGS_SPLIT_TRAIN][i], *other = &first->views[ADCGS_SPLIT_TRAIN][i];
        assert_memory_equal(&one->camera, &other->camera, sizeof one->camera); /* with the near plane */
        assert_true(one->time == other->time);
    }
    assert_memory_equal(scene->points.position, first->points.position, 2 * sizeof *scene->points.position);
    assert_true(scene->points.n == first->points.n && scene->duration == first->duration && scene->n_times == first->n_times);
    assert_true(scene->axes == first->axes);
    adcgs_scene_free(&first);
    adcgs_scene_free(&scene);
}

/** The up direction of the images determines the world's axes. */
static void test_axes(void **state)
{
    static const struct {
        const char *rows;
        int axes;
    } cases[] = {{"[[1,0,0],[0,1,0],[0,0,1]]", ADCGS_AXES_Y_DOWN},
                 {"[[1,0,0],[0,-1,0],[0,0,-1]]", ADCGS_AXES_Y_UP},
                 {"[[1,0,0],[0,0,-1],[0,1,0]]", ADCGS_AXES_Z_UP},
                 {"[[1,0,0],[0,0,1],[0,-1,0]]", ADCGS_AXES_UNKNOWN},
                 {"[[0,1,0],[-1,0,0],[0,0,1]]", ADCGS_AXES_UNKNOWN}};
    put_text("dataset.json", "{\"ids\":[\"c\"]}");
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        char text[256];
        snprintf(text, sizeof text, "{\"orientation\":%s,\"position\":[0,0,0]," LENS "}", cases[i].rows);
        put_text("camera/c.json", text);
        open_good();
        assert_int_equal(scene->axes, cases[i].axes);
        adcgs_scene_free(&scene);
    }
}

/** transforms.json has priority over the files of this layout, which must all be present. */
static void test_detection(void **state)
{
    put_text("transforms.json", "{}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "transforms.json", "frames");
    unlink(in("transforms.json"));
    unlink(in("metadata.json"));
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "not a scene", "metadata.json");
    mend(state);
    assert_int_equal(rename(in("camera"), in("cameras")), 0);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "not a scene", "camera/");
    assert_int_equal(rename(in("cameras"), in("camera")), 0);
}

static void test_bad_lists(void **state)
{
    expect_bad("dataset.json", "", ADCGS_ERR_DATA, "empty, expected JSON");
    expect_bad("dataset.json", "[]", ADCGS_ERR_DATA, "object");
    expect_bad("dataset.json", "{}", ADCGS_ERR_DATA, "ids: expected an array");
    expect_bad("dataset.json", "{\"ids\":[]}", ADCGS_ERR_DATA, "ids: is empty");
    expect_bad("dataset.json", "{\"ids\":7}", ADCGS_ERR_DATA, "ids: expected an array");
    expect_bad("dataset.json", "{\"ids\":[7]}", ADCGS_ERR_DATA, "ids[0]: expected the name");
    expect_bad("dataset.json", "{\"ids\":[\"\"]}", ADCGS_ERR_DATA, "ids[0]: expected the name");
    expect_bad("dataset.json", "{\"ids\":[\"../a\"]}", ADCGS_ERR_DATA, "ids[0]: expected the name");
    expect_bad("dataset.json", "{\"ids\":[\"a\"],\"val_ids\":{}}", ADCGS_ERR_DATA, "train_ids: expected an array");
    expect_bad("dataset.json", "{\"train_ids\":[\"a\"],\"val_ids\":{\"b\":0}}", ADCGS_ERR_DATA, "val_ids: expected an array");
    expect_bad("dataset.json", "{\"train_ids\":[],\"val_ids\":[\"b\"]}", ADCGS_ERR_DATA, "train_ids: is empty");
    expect_bad("dataset.json", "{\"train_ids\":[\"a\",\"c\"],\"val_ids\":[\"b\",\"c\"]}", ADCGS_ERR_DATA,
               "val_ids[1]: c is listed");
    expect_bad("dataset.json", "{\"train_ids\":[\"a\",\"a\"],\"val_ids\":[\"b\"]}", ADCGS_ERR_DATA, "train_ids[1]: a is listed");
    char text[512];
    snprintf(text, sizeof text, "{\"ids\":[\"%0201d\"]}", 0);
    expect_bad("dataset.json", text, ADCGS_ERR_DATA, "ids[0]: expected the name");
    expect_bad("metadata.json", "[1", ADCGS_ERR_DATA, "malformed JSON");
    expect_bad("metadata.json", "{\"a\":{\"warp_id\":0},\"b\":{\"warp_id\":3}}", ADCGS_ERR_DATA, "c: missing");
    expect_bad("metadata.json", "{\"a\":7}", ADCGS_ERR_DATA, "a: warp_id");
    expect_bad("metadata.json", "{\"a\":{}}", ADCGS_ERR_DATA, "a: warp_id");
    expect_bad("metadata.json", "{\"z\":{\"warp_id\":-1}}", ADCGS_ERR_DATA, "z: warp_id");
    expect_bad("metadata.json", "{\"z\":{\"warp_id\":1.5}}", ADCGS_ERR_DATA, "z: warp_id");
    expect_bad("metadata.json", "{\"z\":{\"warp_id\":9223372036854775807}}", ADCGS_ERR_DATA, "z: warp_id");
    put_text("dataset.json", "{\"ids\":[\"d\\n\"]}");
    put_text("metadata.json", "{\"d\\n\":{\"warp_id\":0}}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "rgb/1x: no image of", "d?");
}

static void test_bad_scene(void **state)
{
    expect_bad("scene.json", "{", ADCGS_ERR_DATA, "malformed JSON");
    expect_bad("scene.json", "{\"scale\":1}", ADCGS_ERR_DATA, "center: missing");
    expect_bad("scene.json", "{\"center\":[0,0],\"scale\":1}", ADCGS_ERR_DATA, "center: expected 3");
    expect_bad("scene.json", "{\"center\":[0,0,\"1\"],\"scale\":1}", ADCGS_ERR_DATA, "center: expected 3");
    expect_bad("scene.json", "{\"center\":[0,0,1e10],\"scale\":1}", ADCGS_ERR_DATA, "center: 1e+10");
    expect_bad("scene.json", "{\"center\":[0,0,1]}", ADCGS_ERR_DATA, "scale: missing");
    expect_bad("scene.json", "{\"center\":[0,0,1],\"scale\":0}", ADCGS_ERR_DATA, "scale: 0");
    expect_bad("scene.json", "{\"center\":[0,0,1],\"scale\":null}", ADCGS_ERR_DATA, "scale: expected a number");
    unlink(in("scene.json"));
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_IO, "scene.json", "No such file");
    put_text("scene.json", "{\"center\":[0,0,0],\"scale\":1e9}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "camera/a.json: position", "2e+09");
    put_text("camera/a.json", "{\"orientation\":[[1,0,0],[0,1,0],[0,0,1]],\"position\":[0,0,0]," LENS "}");
    put_text("dataset.json", "{\"ids\":[\"a\"]}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "points.npy: point 0", "2e+09");
}

/** Expects an error for a camera with these fields. */
static void bad_camera(const char *fields, adcgs_status status, const char *what)
{
    char text[512];
    snprintf(text, sizeof text, "{%s}", fields);
    expect_bad("camera/c.json", text, status, what);
}

#define FOCAL ",\"focal_length\":8"
#define MIDDLE FOCAL ",\"principal_point\":[1,1]"

static void test_bad_cameras(void **state)
{
    unlink(in("camera/c.json"));
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_IO, "camera/c.json", "No such file");
    bad_camera("", ADCGS_ERR_DATA, "focal_length: missing");
    bad_camera(PLAIN ",\"focal_length\":0", ADCGS_ERR_DATA, "focal_length: 0");
    bad_camera(PLAIN ",\"focal_length\":[8]", ADCGS_ERR_DATA, "focal_length: expected a number");
    bad_camera(PLAIN FOCAL, ADCGS_ERR_DATA, "principal_point: missing");
    bad_camera(PLAIN FOCAL ",\"principal_point\":[1,1e7]", ADCGS_ERR_DATA, "principal_point: 1e+07");
    bad_camera(PLAIN MIDDLE, ADCGS_ERR_DATA, "image_size: missing");
    bad_camera(PLAIN MIDDLE ",\"image_size\":[6]", ADCGS_ERR_DATA, "image_size: expected 2");
    bad_camera(PLAIN MIDDLE ",\"image_size\":[6,4.5]", ADCGS_ERR_DATA, "image_size: 4.5");
    bad_camera(PLAIN MIDDLE ",\"image_size\":[0,4]", ADCGS_ERR_DATA, "image_size: 0");
    bad_camera(PLAIN MIDDLE ",\"image_size\":[16385,4]", ADCGS_ERR_DATA, "image_size: 16385");
    bad_camera(PLAIN "," LENS ",\"pixel_aspect_ratio\":0", ADCGS_ERR_DATA, "pixel_aspect_ratio: 0");
    bad_camera(PLAIN "," LENS ",\"skew\":1e7", ADCGS_ERR_DATA, "skew: 1e+07");
    bad_camera(PLAIN "," LENS ",\"skew\":60", ADCGS_ERR_DATA, "a tenth of 6x4");
    bad_camera(PLAIN "," LENS ",\"skew\":[0]", ADCGS_ERR_DATA, "skew: expected a number");
    bad_camera(PLAIN "," LENS ",\"radial_distortion\":[-9,0,0]", ADCGS_ERR_DATA, "folds inside the image of 6x4");
    bad_camera(PLAIN "," LENS ",\"radial_distortion\":[0,0,1e7]", ADCGS_ERR_DATA, "radial_distortion: 1e+07");
    bad_camera(PLAIN "," LENS ",\"radial_distortion\":[0,0]", ADCGS_ERR_DATA, "radial_distortion: expected 3");
    bad_camera(PLAIN "," LENS ",\"tangential_distortion\":[0,-4]", ADCGS_ERR_DATA, "folds inside");
    bad_camera(PLAIN "," LENS ",\"tangential\":[0.5]", ADCGS_ERR_DATA, "tangential: expected 2");
    bad_camera(LENS ",\"position\":[0,0,0]", ADCGS_ERR_DATA, "orientation: expected 3 rows");
    bad_camera(LENS ",\"orientation\":[[1,0,0],[0,1],[0,0,1]]", ADCGS_ERR_DATA, "orientation: expected 3 numbers");
    bad_camera(LENS ",\"orientation\":[[1,0,0],[0,1,0],[0,0,-1]],\"position\":[0,0,0]", ADCGS_ERR_DATA,
               "orientation: is a reflection");
    bad_camera(LENS ",\"orientation\":[[2,0,0],[0,2,0],[0,0,2]],\"position\":[0,0,0]", ADCGS_ERR_DATA, "orientation: is scaled");
    bad_camera(LENS ",\"orientation\":[[1,0,0],[0,1,0],[0,0,1]]", ADCGS_ERR_DATA, "position: missing");
    bad_camera(LENS ",\"orientation\":[[1,0,0],[0,1,0],[0,0,1]],\"position\":[0,\"\",0]", ADCGS_ERR_DATA, "position: expected 3");
    put_text("dataset.json", "{\"ids\":[\"d\"]}");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "rgb/1x", "no image of d");
}

/** Replaces one byte of a good file at a time, or ends the file there: never a crash, always a reason in one line. */
static void mutate(const char *name, const char *bytes, size_t size)
{
    static const char values[] = "\0\"[}9-e,\xff\n";
    char changed[512];
    assert_true(size < sizeof changed);
    for (size_t i = 0; i < 2 * size; i++) {
        const size_t at = i / 2;
        memcpy(changed, bytes, size);
        changed[at] = values[at % (sizeof values - 1)];
        put_bytes(name, changed, i % 2 ? at : size);
        error = (adcgs_error){0};
        if (adcgs_scene_open(&scene, folder, NULL, &error) == ADCGS_OK)
            adcgs_scene_free(&scene);
        else
            assert_true(error.text[0] && !strchr(error.text, '\n'));
    }
    put_scene();
}

static void test_mutations(void **state)
{
    for (size_t i = 0; i < ADCGS_COUNTOF(good); i++)
        mutate(good[i].name, good[i].text, strlen(good[i].text));
    mutate("points.npy", NPY NUMBERS, sizeof NPY + sizeof NUMBERS - 2);
}

/** Masks in mask/Nx are used, where present, at the N of the images. */
static void test_masks(void **state)
{
    adcgs_image mask;
    float *rgb;
    assert_true(!mkdir(in("mask"), 0777) && !mkdir(in("mask/1x"), 0777) && !mkdir(in("mask/2x"), 0777));
    assert_int_equal(adcgs_image_alloc(&mask, 6, 4, 1, "mask", &error), ADCGS_OK);
    for (int i = 0; i < 6 * 4; i++)
        mask.data[i] = i % 6 < 2 ? 0.0f : 1.0f;
    expect_good(adcgs_image_write(&mask, in("mask/1x/a.png"), 0, &error));
    expect_good(adcgs_image_write(&mask, in("mask/1x/b.png"), 0, &error));
    expect_good(adcgs_image_write(&mask, in("mask/2x/c.png"), 0, &error));
    adcgs_image_free(&mask);
    open_good();
    const adcgs_scene_view *a = &scene->views[ADCGS_SPLIT_TRAIN][0], *c = &scene->views[ADCGS_SPLIT_TRAIN][1];
    assert_true(a->mask && strstr(a->mask, "mask/1x/a.png") && scene->views[ADCGS_SPLIT_TEST][0].mask && !c->mask);
    expect_good(adcgs_scene_image(scene, a, 1, &rgb, NULL, &error));
    for (int i = 0; i < 3 * 6 * 4; i++)
        assert_int_equal(isnan(rgb[i]), i % 6 < 2);
    free(rgb);
    adcgs_scene_free(&scene);
    put_text("mask/1x/a.png", "no picture");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "mask/1x/a.png", "");
    assert_true(!unlink(in("mask/1x/a.png")) && !unlink(in("mask/1x/b.png")) && !unlink(in("mask/2x/c.png")));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_fields, mend),    cmocka_unit_test_teardown(test_rule, mend),
        cmocka_unit_test_teardown(test_reduced, mend),   cmocka_unit_test_teardown(test_points, mend),
        cmocka_unit_test_teardown(test_apart, mend),     cmocka_unit_test_teardown(test_axes, mend),
        cmocka_unit_test_teardown(test_detection, mend), cmocka_unit_test_teardown(test_bad_lists, mend),
        cmocka_unit_test_teardown(test_bad_scene, mend), cmocka_unit_test_teardown(test_bad_cameras, mend),
        cmocka_unit_test_teardown(test_mutations, mend), cmocka_unit_test_teardown(test_masks, mend),
    };
    int failed = cmocka_run_group_tests(tests, setup, remove_folder);
    failed += adcgs_test_hypernerf_real();
    return failed;
}
