/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Faults of files, frames and poses of a scene: each is refused with the fault named. */
#include "scene_files.h"
#include "second_sources.h"

#include "scene/layouts/open.h"
#include "scene/pose_check.h"
#include "scene/scene.h"

#include <math.h>

static void test_bad_files(void **state)
{
    expect_error(adcgs_scene_open(&scene, in("nowhere"), NULL, &error), ADCGS_ERR_IO, "nowhere", "No such file");
    expect_error(adcgs_scene_open(&scene, "", NULL, &error), ADCGS_ERR_IO, "cannot open", "");
    expect_error(adcgs_scene_open(&scene, folder, NULL, &error), ADCGS_ERR_DATA, "not a scene", "transforms.json");
    expect_bad("{\"frames\":[\n\n,]}", ADCGS_ERR_DATA, "line 3", "malformed JSON");
    expect_bad("{\"w\":1e999}", ADCGS_ERR_DATA, "line 1", "malformed JSON");
    expect_bad("{\"w\":NaN}", ADCGS_ERR_DATA, "line 1", "malformed JSON");
    expect_bad("", ADCGS_ERR_DATA, "empty, expected JSON", "");
    expect_bad("[]", ADCGS_ERR_DATA, "object", "");
    expect_bad("{}", ADCGS_ERR_DATA, "frames", "array");
    expect_bad("{\"frames\":{}}", ADCGS_ERR_DATA, "frames", "array");
    expect_bad("{\"frames\":[]}", ADCGS_ERR_DATA, "frames", "empty");
    expect_bad("{\"frames\":[7]}", ADCGS_ERR_DATA, "frames[0]", "object");
    expect_bad("{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", "") "]}", ADCGS_ERR_DATA, "frames", "training");
    expect_bad("{\"fps\":0,\"frames\":[]}", ADCGS_ERR_DATA, "fps", "0");
    expect_bad("{\"ply_file_path\":1,\"frames\":[]}", ADCGS_ERR_DATA, "ply_file_path", "string");
}

/** One good frame, then one with the given fields. */
static void expect_bad_frame(const char *fields, adcgs_status status, const char *field, const char *what)
{
    char json[1024], place[64];
    snprintf(json, sizeof json, "{\"w\":6,\"h\":4,\"fl_x\":5,\"frames\":[" FRAME("a.ppm", ",\"time\":0") ",{%s}]}", fields);
    snprintf(place, sizeof place, "frames[1].%s", field);
    expect_bad(json, status, place, what);
}

#define GOOD "\"file_path\":\"b.ppm\",\"time\":0.5,\"transform_matrix\":" IDENTITY

static void test_bad_frames(void **state)
{
    expect_bad_frame("\"time\":0,\"transform_matrix\":" IDENTITY, ADCGS_ERR_DATA, "file_path", "name");
    expect_bad_frame("\"time\":0,\"file_path\":\"\",\"transform_matrix\":" IDENTITY, ADCGS_ERR_DATA, "file_path", "name");
    expect_bad_frame("\"time\":0,\"file_path\":\"./zz/y\",\"transform_matrix\":" IDENTITY, ADCGS_ERR_DATA, "file_path", "zz/y");
    expect_bad_frame("\"file_path\":\"b.ppm\",\"transform_matrix\":" IDENTITY, ADCGS_ERR_DATA, "time", "missing");
    expect_bad_frame("\"file_path\":\"b.ppm\",\"time\":1e30,\"transform_matrix\":" IDENTITY, ADCGS_ERR_DATA, "time", "1e+30");
    expect_bad_frame("\"file_path\":\"b.ppm\",\"time\":\"0\",\"transform_matrix\":" IDENTITY, ADCGS_ERR_DATA, "time", "number");
    expect_bad_frame(GOOD ",\"w\":7.5", ADCGS_ERR_DATA, "w", "whole");
    expect_bad_frame(GOOD ",\"w\":0", ADCGS_ERR_DATA, "w", "0");
    expect_bad_frame(GOOD ",\"h\":20000", ADCGS_ERR_DATA, "h", "20000");
    expect_bad_frame(GOOD ",\"fl_x\":-1", ADCGS_ERR_DATA, "fl_x", "-1");
    expect_bad_frame(GOOD ",\"fl_y\":null", ADCGS_ERR_DATA, "fl_y", "number");
    expect_bad_frame(GOOD ",\"cx\":1e30", ADCGS_ERR_DATA, "cx", "1e+30");
    expect_bad_frame(GOOD ",\"k1\":\"0\"", ADCGS_ERR_DATA, "k1", "number");
    expect_bad_frame(GOOD ",\"p2\":1e7", ADCGS_ERR_DATA, "p2", "1e+07");
    expect_bad_frame(GOOD ",\"k5\":0.1", ADCGS_ERR_DATA, "k5", "OPENCV has no k5");
    expect_bad_frame(GOOD ",\"camera_model\":\"PINHOLE\",\"k1\":0.1", ADCGS_ERR_DATA, "k1", "PINHOLE has no k1");
    expect_bad_frame(GOOD ",\"camera_model\":\"SIMPLE_PINHOLE\",\"p1\":1", ADCGS_ERR_DATA, "p1", "SIMPLE_PINHOLE has no p1");
    expect_bad_frame(GOOD ",\"camera_model\":\"SIMPLE_RADIAL\",\"k2\":1", ADCGS_ERR_DATA, "k2", "SIMPLE_RADIAL has no k2");
    expect_bad_frame(GOOD ",\"camera_model\":\"RADIAL\",\"k3\":1", ADCGS_ERR_DATA, "k3", "RADIAL has no k3");
    expect_bad_frame(GOOD ",\"sk_x\":0.5", ADCGS_ERR_UNSUPPORTED, "sk_x", "0.5");
    static const char *const others[] = {"THIN_PRISM_FISHEYE", "EQUIRECTANGULAR", "FISHEYE624",
                                         "ORTHOPHOTO",         "VR180_L",         "opencv"};
    for (size_t i = 0; i < ADCGS_COUNTOF(others); i++) {
        char fields[512];
        snprintf(fields, sizeof fields, GOOD ",\"camera_model\":\"%s\"", others[i]);
        expect_bad_frame(fields, ADCGS_ERR_UNSUPPORTED, "camera_model", others[i]);
    }
    expect_bad_frame(GOOD ",\"latlong\":true", ADCGS_ERR_UNSUPPORTED, "latlong", "panoramic");
    expect_bad_frame(GOOD ",\"ftheta_p0\":1", ADCGS_ERR_UNSUPPORTED, "ftheta_p0", "f-theta");
    expect_bad_frame(GOOD ",\"camera_model\":3", ADCGS_ERR_DATA, "camera_model", "string");
    expect_bad_frame(GOOD ",\"camera_model\":\"OPENCV\",\"is_fisheye\":true", ADCGS_ERR_DATA, "is_fisheye", "OPENCV");
    expect_bad_frame(GOOD ",\"is_fisheye\":true,\"p1\":0.1", ADCGS_ERR_DATA, "p1", "OPENCV_FISHEYE has no p1");
    expect_bad_frame(GOOD ",\"camera_model\":\"RADIAL_FISHEYE\",\"k3\":1", ADCGS_ERR_DATA, "k3", "RADIAL_FISHEYE has no k3");
    expect_bad("{\"frames\":[" FRAME("a.ppm", "") "]}", ADCGS_ERR_DATA, "fl_x", "missing");
    expect_bad("{\"is_fisheye\":true,\"camera_angle_x\":1,\"frames\":[" FRAME("a.ppm", "") "]}", ADCGS_ERR_DATA, "fl_x",
               "fisheye");
    expect_bad("{\"w\":6,\"frames\":[" FRAME("a.ppm", "") "]}", ADCGS_ERR_DATA, "frames[0].h", "missing");
    expect_bad("{\"fl_x\":5,\"frames\":[" FRAME("a.ppm", ",\"k1\":-3") "]}", ADCGS_ERR_DATA, "frames[0]: ", "folds");
}

static void expect_bad_pose(const char *matrix, const char *what)
{
    char fields[512];
    snprintf(fields, sizeof fields, "\"file_path\":\"b.ppm\",\"time\":0,\"transform_matrix\":%s", matrix);
    expect_bad_frame(fields, ADCGS_ERR_DATA, "transform_matrix", what);
}

static void test_bad_poses(void **state)
{
    expect_bad_pose("null", "4 rows");
    expect_bad_pose("[[1,0,0,0],[0,1,0,0]]", "4 rows");
    expect_bad_pose("[[1,0,0],[0,1,0],[0,0,1]]", "4 rows");
    expect_bad_pose("[[1,0,0,0],[0,1,0,0],[0,0,1,\"4\"],[0,0,0,1]]", "row 2 column 3");
    expect_bad_pose("[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,2]]", "last row");
    expect_bad_pose("[[1,0,0,0],[0,1,0,0],[0,0,0,4],[0,0,0,1]]", "singular");
    expect_bad_pose("[[0,0,0,0],[0,0,0,0],[0,0,0,4],[0,0,0,1]]", "singular");
    expect_bad_pose("[[2,0,0,0],[0,2,0,0],[0,0,2,4],[0,0,0,1]]", "scaled");
    expect_bad_pose("[[1,0,0,0],[0,1,0.1,0],[0,0,1,4],[0,0,0,1]]", "orthonormal");
    expect_bad_pose("[[-1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]", "reflection");
    expect_bad_pose("[[1e200,0,0,0],[0,1e200,0,0],[0,0,1e200,4],[0,0,0,1]]", "too large");
    double infinite[12] = {1, 0, 0, INFINITY, 0, 1, 0, 0, 0, 0, 1, 0};
    assert_string_equal(adcgs_pose_from_opengl(infinite), "holds a value that is not finite");
}

/** Replaces one byte of a good file at a time, or ends the file there: never a crash, always a reason. */
static void test_mutations(void **state)
{
    static const char good[] = "{\"w\":6,\"h\":4,\"fl_x\":5,\"k1\":0,\"ply_file_path\":\"points3d.ply\",\"frames\":[" FRAME(
        "a.ppm", ",\"time\":0") "," FRAME("b.ppm", ",\"time\":1,\"cx\":3") "]}";
    static const char values[] = "\0\"[}9-e,\xff";
    char bytes[sizeof good];
    put_text("points3d.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
                             "end_header\n");
    for (size_t i = 0; i < 2 * (sizeof good - 1); i++) {
        const size_t at = i / 2, size = i % 2 ? at : sizeof good - 1;
        memcpy(bytes, good, sizeof good);
        bytes[at] = values[at % (sizeof values - 1)];
        put_bytes("transforms.json", bytes, size);
        error = (adcgs_error){0};
        if (adcgs_scene_open(&scene, folder, NULL, &error) == ADCGS_OK)
            adcgs_scene_free(&scene);
        else
            assert_true(error.text[0] && !strchr(error.text, '\n'));
    }
}

int adcgs_test_scene_faults(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_bad_files, no_files),
        cmocka_unit_test_teardown(test_bad_frames, no_files),
        cmocka_unit_test_teardown(test_bad_poses, no_files),
        cmocka_unit_test_teardown(test_mutations, no_files),
    };
    return cmocka_run_group_tests_name("scene faults", tests, setup, remove_folder);
}
