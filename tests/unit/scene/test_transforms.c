/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Transforms files as other programs write them: sizes, times, names, lists, paths of other machines. */
#include "layout_files.h"
#include "opened_scene.h"

/** A transforms file of n frames. The fields of a frame in addition to its pose are a format of its number, given twice. */
static void put_file(const char *name, const char *root, const char *frame, int first, int n)
{
    char *text = malloc(65536);
    assert_non_null(text);
    size_t at = (size_t)sprintf(text, "{%s\"frames\":[", root);
    for (int i = first; i < first + n; i++) {
        double pose[12];
        rig_pose(i, pose);
        at += (size_t)sprintf(text + at, "%s{", i > first ? "," : "");
        at += (size_t)sprintf(text + at, frame, i, i);
        at += (size_t)sprintf(text + at, ",\"transform_matrix\":%s}", json_opengl(pose));
    }
    sprintf(text + at, "]}");
    put_text(name, text);
    free(text);
}

static void put_images(const char *place, int n, int width, int height)
{
    put_folder(place);
    for (int i = 0; i < n; i++) {
        char path[160];
        snprintf(path, sizeof path, "%s/%d.ppm", place, i);
        put_picture(path, i, width, height);
    }
}

static void open_good(int n_remarks)
{
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, folder, NULL, &error));
    if (scene->n_remarks != n_remarks)
        fail_msg("%d remarks, expected %d: %s", scene->n_remarks, n_remarks, scene->n_remarks ? scene->remarks[0] : "");
}

static void open_bad(const char *first, const char *second)
{
    adcgs_scene_free(&scene);
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, first, second);
}

static void expect_remark(const char *first, const char *second)
{
    for (int i = 0; i < scene->n_remarks; i++)
        if (strstr(scene->remarks[i], first) && strstr(scene->remarks[i], second))
            return;
    fail_msg("no remark says \"%s\" and \"%s\"; the first: %s", first, second, scene->n_remarks ? scene->remarks[0] : "none");
}

static const adcgs_scene_view *train(int i)
{
    return &scene->views[ADCGS_SPLIT_TRAIN][i];
}

#define IN_IMAGES "\"file_path\":\"images/%d.ppm\""
#define INTRINSICS "\"fl_x\":80,\"fl_y\":80,\"cx\":48,\"cy\":32,\"w\":96,\"h\":64,"

/* ---- Sizes ---- */

/** Without w and h each image has its own size. Angles of view and principal points are those of each image. */
static void test_own_sizes(void **state)
{
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    put_picture("images/2.ppm", 2, 12, 16);
    put_file("transforms.json", "", IN_IMAGES ",\"fl_x\":20,\"cx\":6", 0, 9);
    open_good(0);
    assert_true(train(0)->camera.width == 24 && train(1)->camera.width == 12 && train(1)->camera.height == 16);
    assert_true(train(1)->camera.cx == 6.0 && train(1)->camera.cy == 8.0 && train(1)->camera.fx == 20.0);
    put_file("transforms.json", "\"camera_angle_x\":1,", IN_IMAGES, 0, 9);
    open_good(0);
    assert_true(fabs(train(0)->camera.fx - 2.0 * train(1)->camera.fx) < 1e-9 && train(1)->camera.cx == 6.0);
    put_file("transforms.json", "\"fl_x\":20,\"camera_angle_x\":1.0808,", IN_IMAGES ",\"w\":24,\"h\":16", 0, 1);
    open_bad("no frame is left", "");
    put_file("transforms.json", "\"fl_x\":80,\"camera_angle_x\":1.0808,", IN_IMAGES ",\"cx\":12", 0, 9);
    open_bad("transforms.json: fl_x: 80, but camera_angle_x 1.0808 is 20", "at a width of 24 pixels");
    put_file("transforms.json", "\"camera_angle_x\":1.08,", IN_IMAGES ",\"fl_x\":80", 0, 9); /* the frame's own has priority */
    open_good(0);
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES, 0, 9); /* one focal length: ambiguous between a crop and a reduction */
    open_good(1);
    expect_remark("24x16 and 12x16", "fl_x is one for all");
    assert_true(train(1)->camera.fx == 20.0 && train(1)->camera.cx == 6.0);
}

/** Numbers of the full size with reduced images are scaled. Another aspect is refused, with both named. */
static void test_reduced(void **state)
{
    put_images("images_4", 9, RIG_WIDTH, RIG_HEIGHT);
    put_file("transforms.json", INTRINSICS, "\"file_path\":\"images_4/%d.ppm\"", 0, 9);
    open_good(0);
    assert_true(train(0)->camera.width == 24 && train(0)->camera.fx == 20.0 && train(0)->camera.cy == 8.0);
    put_file("transforms.json", INTRINSICS, IN_IMAGES, 0, 9); /* only reduced images exist */
    open_good(0);
    assert_true(strstr(train(0)->path, "images_4/1.ppm") && train(0)->camera.fx == 20.0);
    put_file("transforms.json", "\"fl_x\":80,\"w\":97,\"h\":64,", IN_IMAGES, 0, 9); /* 24.25: rounded */
    open_good(0);
    assert_true(fabs(train(0)->camera.fx - 80.0 * 24 / 97) < 1e-9);
    put_file("transforms.json", "\"fl_x\":80,\"w\":4050,\"h\":3036,", IN_IMAGES, 0, 9);
    for (int i = 0; i < 9; i++) {
        char path[64];
        snprintf(path, sizeof path, "images_4/%d.ppm", i);
        put_picture(path, i, 1013, 759);
    }
    open_good(0);
    assert_true(train(0)->camera.width == 1013 && fabs(train(0)->camera.fx - 80.0 * 1013 / 4050) < 1e-9);
    put_file("transforms.json", "\"fl_x\":80,\"w\":4050,\"h\":2278,", IN_IMAGES, 0, 9);
    open_bad("images_4/0.ppm: 1013x759 pixels", "expected 4050x2278");
    put_file("transforms.json", "\"fl_x\":80,\"w\":759,\"h\":1013,", IN_IMAGES, 0, 9);
    open_bad("1013x759 pixels", "expected 759x1013");
}

/* ---- Times ---- */

static void test_times(void **state)
{
    static const struct {
        const char *frame, *remark;
    } cases[] = {
        {IN_IMAGES ",\"time\":%d", "time ranges from 0 to 8 and is scaled to 0 to 1; if these are seconds, "
                                   "give --fps 1"},
        {IN_IMAGES ",\"time\":0.%d", NULL},
        {IN_IMAGES ",\"time\":17000000%d.5", "time ranges from 170000000.5 to 170000008.5"},
        {IN_IMAGES ",\"time\":-%d", "time ranges from -8 to 0"},
        {IN_IMAGES ",\"time\":1700000000000%d25", "time ranges from 1700000000000025 to 1700000000000825"},
    };
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    for (size_t i = 0; i < ADCGS_COUNTOF(cases); i++) {
        put_file("transforms.json", "\"fl_x\":20,", cases[i].frame, 0, 9);
        open_good(cases[i].remark != NULL);
        if (!cases[i].remark)
            continue;
        expect_remark(cases[i].remark, "");
        assert_true(fabs(scene->duration - 8 / 30.0) < 1e-9 && scene->n_times == 7 && !scene->counts);
        assert_true(fabs(train(0)->time - (i == 3 ? 7 : 1) / 30.0) < 1e-9);
    }
    const adcgs_scene_options slow = {.rate = {10, 1}};
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"time\":%d", 0, 9);
    adcgs_scene_free(&scene);
    expect_good(adcgs_scene_open(&scene, folder, &slow, &error));
    assert_true(fabs(scene->duration - 0.8) < 1e-9);
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"time\":\"%d\"", 0, 9);
    open_bad("frames[0].time", "expected a number");
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"time\":%d", 1, 8); /* of all splits together */
    assert_int_equal(rename(in("transforms.json"), in("transforms_train.json")), 0);
    put_file("transforms_test.json", "\"fl_x\":20,", IN_IMAGES ",\"time\":%d", 0, 1);
    open_good(1);
    assert_true(scene->views[ADCGS_SPLIT_TEST][0].time == 0.0 && fabs(train(7)->time - scene->duration) < 1e-12);
}

/** Frames that look like a video's, without time. */
static void test_no_times(void **state)
{
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES, 0, 9);
    open_good(0);
    assert_true(scene->counts && scene->n_times == 1);
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"timestamp\":170000000%d.25", 0, 9);
    open_good(1);
    expect_remark("timestamp, which is not supported", "give each frame a time");
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"t\":\"%d\"", 0, 9);
    open_good(1);
    expect_remark("frames have t, which is not supported", "");
    static const char *const clocks[] = {"timestep_index", "Time", "frame_idx", "capturedTimeMs", "seconds"};
    for (size_t i = 0; i < ADCGS_COUNTOF(clocks); i++) {
        char frame[100], wanted[100];
        snprintf(frame, sizeof frame, "\"file_path\":\"images/%%d.ppm\",\"%s\":%%d", clocks[i]);
        put_file("transforms.json", "\"fl_x\":20,", frame, 0, 9);
        open_good(1);
        snprintf(wanted, sizeof wanted, "frames have %s, which is not supported", clocks[i]);
        expect_remark(wanted, "");
    }
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"time\":null,\"colmap_im_id\":%d", 0, 9);
    open_good(0);
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"timestamp\":7", 0, 9); /* all equal: no clock */
    open_good(0);
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES ",\"timestamp\":%d,\"time\":0", 0, 9);
    open_good(0);
    assert_false(scene->counts);
}

/* ---- Names ---- */

static void test_names(void **state)
{
    static const char *const folders[] = {"front", "left", "back"};
    char text[800], list[6000] = "{\"fl_x\":20,\"frames\":[";
    for (int i = 0; i < 3; i++) {
        double pose[12];
        put_images(folders[i], 3, RIG_WIDTH, RIG_HEIGHT);
        for (int k = 0; k < 3; k++) {
            rig_pose(3 * i + k, pose);
            snprintf(text, sizeof text, "%s{\"file_path\":\"%s/%d.ppm\",\"transform_matrix\":%s}", i + k ? "," : "", folders[i],
                     k, json_opengl(pose));
            strcat(list, text);
        }
    }
    strcat(list, "]}");
    put_text("transforms.json", list);
    open_good(0);
    assert_string_equal(train(0)->camera.name, "front_1");
    assert_string_equal(train(2)->camera.name, "left_0");
    assert_string_equal(scene->views[ADCGS_SPLIT_TEST][0].camera.name, "front_0");
    for (uint32_t i = 0; i < scene->n_views[ADCGS_SPLIT_TRAIN]; i++)
        for (uint32_t k = 0; k < i; k++)
            assert_string_not_equal(train((int)i)->camera.name, train((int)k)->camera.name);
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT); /* names that differ stay unchanged */
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES, 0, 9);
    open_good(0);
    assert_string_equal(train(0)->camera.name, "1");
}

/** A frame for both training and testing is refused; other inconsistencies cause a remark. */
static void test_lists(void **state)
{
#define TRAIN "\"train_filenames\":[\"images/1.ppm\",\"./images/2.ppm\",\"images\\\\3.ppm\"]"
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    put_file("transforms.json",
             "\"fl_x\":20," TRAIN ",\"val_filenames\":[\"images/4.ppm\"],\"test_filenames\":[\"images/4.ppm\"],", IN_IMAGES, 0,
             9);
    open_good(0);
    assert_true(scene->n_views[ADCGS_SPLIT_TRAIN] == 3 && scene->n_views[ADCGS_SPLIT_TEST] == 1);
    put_file("transforms.json", "\"fl_x\":20," TRAIN ",\"test_filenames\":[\"images/2.ppm\"],", IN_IMAGES, 0, 9);
    open_bad("test_filenames: images/2.ppm is in train_filenames, too", "");
    put_file("transforms.json", "\"fl_x\":20," TRAIN ",\"test_filenames\":[\"images/44.ppm\"],", IN_IMAGES, 0, 9);
    open_bad("test_filenames: images/44.ppm is the file_path of no frame", "");
    put_file("transforms.json", "\"fl_x\":20,\"test_filenames\":[\"images/4.ppm\"],", IN_IMAGES, 0, 9);
    open_bad("train_filenames: missing", "");
    put_file("transforms.json", "\"fl_x\":20,\"train_filenames\":[7],", IN_IMAGES, 0, 9);
    open_bad("train_filenames: element 0", "");
    unlink(in("transforms.json"));
    put_file("transforms_train.json", "\"fl_x\":20,", IN_IMAGES, 0, 5);
    put_file("transforms_test.json", "\"fl_x\":20,", "\"file_path\":\"./images/%d\"", 4, 2);
    open_bad("images/4.ppm is listed for training and for testing", "");
    put_file("transforms_test.json", "\"fl_x\":20,", IN_IMAGES, 5, 2);
    put_file("transforms_val.json", "\"fl_x\":20,", IN_IMAGES, 4, 2);
    open_good(1);
    expect_remark("1 frame for training, such as images/4.ppm, is listed for validation", "");
    unlink(in("transforms_val.json"));
    put_file("transforms_train.json", "\"fl_x\":20,", "\"file_path\":\"images/3.ppm\"", 0, 3);
    open_good(1);
    expect_remark("1 frame for training comes more than once, such as images/3.ppm", "");
}

/* ---- Paths ---- */

static void test_paths(void **state)
{
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    put_images("masks", 9, RIG_WIDTH, RIG_HEIGHT);
    static const char *const good[] = {"images\\\\%d.ppm",
                                       ".\\\\images\\\\%d.ppm",
                                       "C:\\\\Users\\\\me\\\\scan\\\\images\\\\%d.ppm",
                                       "D:/scan/images/%d.ppm",
                                       "/home/me/scan/images/%d.ppm",
                                       "/home/me/%d/../images/%d"};
    for (size_t i = 0; i < ADCGS_COUNTOF(good); i++) {
        char frame[200];
        snprintf(frame, sizeof frame, "\"file_path\":\"%s\"%s", good[i],
                 i == 2 ? ",\"mask_path\":\"C:\\\\x\\\\masks\\\\%d.ppm\"" : "");
        put_file("transforms.json", "\"fl_x\":20,", frame, 0, 9);
        open_good(i != 2);
        if (i != 2) /* frames that name none of the masks in the folder */
            expect_remark("folder masks exists, but 9 of 9 images have no mask by mask_path", "");
        assert_non_null(strstr(train(0)->path, "images/1.ppm"));
        assert_true(!train(0)->mask == (i != 2));
    }
    put_file("transforms.json", "\"fl_x\":20,", "\"file_path\":\"C:\\\\scan\\\\none\\\\x%d.ppm\"", 0, 9);
    open_bad("frames[0].file_path: no such image: C:\\scan\\none\\x0.ppm, a Windows path", "nor an image of its name next to");
    put_file("transforms.json", "\"fl_x\":20,", "\"file_path\":\"images/x%d.ppm\"", 0, 9);
    open_bad("frames[0].file_path: no such image: images/x0.ppm", "");
}

/** Names in another letter case or with another extension find their image, if only one file matches. */
static void test_likeness(void **state)
{
    static const char *const good[] = {"images/%d.PPM", "./Images/%d.ppm", "IMAGES\\\\%d.Ppm",
                                       "images/%d.jpg", "images/./%d.ppm", "Images/%d"};
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    for (size_t i = 0; i < ADCGS_COUNTOF(good); i++) {
        char frame[100];
        snprintf(frame, sizeof frame, "\"file_path\":\"%s\"", good[i]);
        put_file("transforms.json", "\"fl_x\":20,", frame, 0, 9);
        open_good(0);
        assert_string_equal(train(0)->camera.name, "1");
        assert_int_equal(train(0)->camera.width, RIG_WIDTH);
    }
    put_picture("images/1.PPM", 1, 12, 16);
    put_file("transforms.json", "\"fl_x\":20,", "\"file_path\":\"images/%d.ppm\",\"fl_x\":20", 0, 9); /* exact: preferred */
    open_good(0);
    assert_int_equal(train(0)->camera.width, RIG_WIDTH);
    put_file("transforms.json", "\"fl_x\":20,", "\"file_path\":\"images/%d.Ppm\"", 0, 9);
    open_bad("frames[1].file_path: no such image: images/1.Ppm", "");
    put_picture("images/0.png", 0, 12, 16);
    put_file("transforms.json", "\"fl_x\":20,", "\"file_path\":\"images/%d.PPM\"", 0, 1);
    open_bad("no frame is left", "");
    put_file("transforms.json", "\"fl_x\":20,", "\"file_path\":\"images/%d.jpg\"", 0, 1); /* two files match */
    open_bad("frames[0].file_path: no such image: images/0.jpg", "");
}

/** Missing points are skipped with a remark. An error in a field of the whole file is reported without a frame. */
static void test_root(void **state)
{
    put_images("images", 9, RIG_WIDTH, RIG_HEIGHT);
    put_file("transforms.json", "\"fl_x\":20,\"ply_file_path\":\"sparse_pc.ply\",", IN_IMAGES, 0, 9);
    open_good(1);
    expect_remark("ply_file_path: there is no sparse_pc.ply", "");
    put_file("transforms.json", "\"fl_x\":20,\"camera_model\":\"OPENCV_FISHEYE\",\"p1\":-0.5,", IN_IMAGES, 0, 9);
    open_bad("transforms.json: p1: -0.5", "OPENCV_FISHEYE has no p1");
    put_file("transforms.json", "\"fl_x\":20,\"camera_model\":\"OPENCV_FISHEYE\",", IN_IMAGES ",\"p1\":-0.5", 0, 9);
    open_bad("transforms.json: frames[0].p1: -0.5", "");
    put_file("transforms.json", "\"fl_x\":20,", IN_IMAGES, 0, 7);
    open_good(1);
    expect_remark("2 of 9 images in images/ have no pose", "");
    put_file("transforms.json", "\"fl_x\":20,\"mask_path\":\"images/2.ppm\",", IN_IMAGES, 0, 9); /* one for all */
    open_good(0);
    assert_non_null(strstr(train(0)->mask, "images/2.ppm"));
    put_bytes("transforms.json", "\xff\xfe{\0}\0", 6);
    open_bad("transforms.json: text in UTF-16", "UTF-8");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_own_sizes, clean), cmocka_unit_test_teardown(test_reduced, clean),
        cmocka_unit_test_teardown(test_times, clean),     cmocka_unit_test_teardown(test_no_times, clean),
        cmocka_unit_test_teardown(test_names, clean),     cmocka_unit_test_teardown(test_lists, clean),
        cmocka_unit_test_teardown(test_paths, clean),     cmocka_unit_test_teardown(test_root, clean),
        cmocka_unit_test_teardown(test_likeness, clean),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
