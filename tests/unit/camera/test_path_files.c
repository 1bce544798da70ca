/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths of other programs: angles, .chan, USD as text; written and read again, made by hand, and invalid. */
#include "outside_files.h"

#include "camera/euler.h"
#include "camera/path_files.h"
#include "geometry/rotation.h"

#include <math.h>

#define KEYS 5
#define DEGREE 0.017453292519943295

static const adcgs_info info =
    {.time_start = 1.0, .time_end = 9.0, .frame_rate = 10.0, .scene_scale = 1.0, .axes = "right-handed, z up", .units = "metre"};
static const adcgs_camera like = {.width = 64, .height = 48, .fx = 70, .fy = 71, .cx = 30, .cy = 25, .near_plane = 0.125};

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static adcgs_status read_path(const char *name, adcgs_camera_path *frames, adcgs_camera_path_request *request)
{
    request->camera = in(name);
    *frames = (adcgs_camera_path){0};
    return adcgs_camera_path_read(frames, &info, request, &like, &error);
}

static void read_good(const char *name, adcgs_camera_path *frames)
{
    adcgs_camera_path_request request = {0};
    if (read_path(name, frames, &request) != ADCGS_OK)
        fail_msg("%s", error.text);
}

/** A rotation in OpenCV axes, as of a camera: about x, y, z of the world, one after the other. */
static void turned(double pose[12], const char *axes, const double degrees[3])
{
    double columns[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const char *axis = axes; *axis; axis++) {
        double about[3] = {0};
        about[*axis - 'x'] = 1.0;
        for (int c = 0; c < 3; c++)
            adcgs_rotate_about(about, DEGREE * degrees[*axis - 'x'], columns[c]);
    }
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++)
            pose[4 * i + c] = columns[c][i];
}

static double pose_difference(const double a[12], const double b[12])
{
    double most = 0.0;
    for (int i = 0; i < 12; i++)
        most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

/* Angles equal turns about the axes, one after the other, in each order. They are restored from the pose, straight up too. */
static void test_angles(void **state)
{
    uint64_t seed = 3;
    for (int order = 0; adcgs_rotation_orders[order]; order++)
        for (int n = 0; n < 200; n++) {
            double degrees[3], again[3] = {0}, pose[12] = {0}, expected[12] = {0};
            for (int i = 0; i < 3; i++)
                degrees[i] = n % 2 ? 720.0 * uniform(&seed) - 360.0 : 90.0 * floor(8.0 * uniform(&seed));
            turned(expected, adcgs_rotation_orders[order], degrees);
            adcgs_euler_to_pose(degrees, (adcgs_rotation_order)order, pose);
            assert_true(pose_difference(pose, expected) < 1e-12);
            adcgs_euler_from_pose(pose, (adcgs_rotation_order)order, again);
            memset(pose, 0, sizeof pose);
            adcgs_euler_to_pose(again, (adcgs_rotation_order)order, pose);
            if (pose_difference(pose, expected) > 1e-7)
                fail_msg("%s, %g %g %g", adcgs_rotation_orders[order], degrees[0], degrees[1], degrees[2]);
        }
}

static void random_keys(adcgs_camera_key keys[KEYS], double step, int centred)
{
    uint64_t seed = 11;
    for (int k = 0; k < KEYS; k++) {
        double degrees[3];
        adcgs_camera *const c = &keys[k].frame.camera;
        keys[k] = (adcgs_camera_key){.at = 2.0 + step * k, .frame = {like, 3.0 + uniform(&seed)}};
        for (int i = 0; i < 3; i++)
            degrees[i] = 360.0 * uniform(&seed);
        turned(c->cam_to_world, "xyz", degrees);
        for (int i = 0; i < 3; i++)
            c->cam_to_world[4 * i + 3] = 10.0 * uniform(&seed) - 5.0;
        c->fx = c->fy = 40.0 + 30.0 * uniform(&seed);
        c->cx = 32.0;
        c->cy = 24.0;
        if (!centred) {
            c->fx *= 1.25;
            c->cx = 20.0 + uniform(&seed);
            c->cy = 30.0 + uniform(&seed);
        }
    }
}

static void expect_same(const adcgs_camera *a, const adcgs_camera *b, double tolerance)
{
    assert_true(a->width == b->width && a->height == b->height);
    assert_true(pose_difference(a->cam_to_world, b->cam_to_world) < tolerance);
    assert_true(fabs(a->fx - b->fx) < tolerance && fabs(a->fy - b->fy) < tolerance);
    assert_true(fabs(a->cx - b->cx) < tolerance && fabs(a->cy - b->cy) < tolerance && a->near_plane == b->near_plane);
}

/* ---- .chan ---- */

static void test_chan_again(void **state)
{
    adcgs_camera_key keys[KEYS];
    adcgs_camera_path frames;
    for (int order = 0; adcgs_rotation_orders[order]; order++) {
        adcgs_camera_path_request request = {.order = (adcgs_rotation_order)order};
        random_keys(keys, 0.1, 1);
        assert_int_equal(adcgs_camera_keys_write(keys, KEYS, 0, &info, 10.0, request.order, in("a.chan"), &error), ADCGS_OK);
        assert_int_equal(read_path("a.chan", &frames, &request), ADCGS_OK);
        assert_true(frames.n == KEYS && frames.frame_rate == 10.0);
        for (int k = 0; k < KEYS; k++) {
            expect_same(&frames.frame[k].camera, &keys[k].frame.camera, 1e-8);
            assert_true(fabs(frames.frame[k].time - (1.0 + 0.1 * k)) < 1e-12);
        }
        adcgs_camera_path_free(&frames);
    }
    /* Keys a second apart: frames between them, which pass through them. */
    random_keys(keys, 1.0, 1);
    assert_int_equal(adcgs_camera_keys_write(keys, KEYS, 0, &info, 10.0, ADCGS_ROTATION_XYZ, in("b.chan"), &error), ADCGS_OK);
    read_good("b.chan", &frames);
    assert_int_equal(frames.n, 10 * (KEYS - 1) + 1);
    for (int k = 0; k < KEYS; k++)
        expect_same(&frames.frame[10 * k].camera, &keys[k].frame.camera, 1e-8);
    adcgs_camera_path_free(&frames);
}

static void test_chan_by_hand(void **state)
{
    adcgs_camera_path frames;
    put_text("c.chan", "# a comment\n1001\t0 0 4\t0 0 0\t90\r\n\n 1002, 1, 2, 3, 0, 90, 0\n1003 0 0 0 90 0 0 # up\n");
    read_good("c.chan", &frames);
    const double straight[12] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 4}, left[12] = {0, 0, -1, 1, 0, -1, 0, 2, -1, 0, 0, 3};
    assert_int_equal(frames.n, 3);
    assert_true(pose_difference(frames.frame[0].camera.cam_to_world, straight) < 1e-12);
    assert_true(fabs(frames.frame[0].camera.fy - 24.0) < 1e-9 && fabs(frames.frame[0].camera.fx - 24.0) < 1e-9);
    assert_true(pose_difference(frames.frame[1].camera.cam_to_world, left) < 1e-12);
    assert_true(frames.frame[1].camera.fx == like.fx && frames.frame[1].camera.cx == like.cx); /* no lens in the file */
    assert_true(fabs(frames.frame[2].camera.cam_to_world[6] - 1.0) < 1e-12);                   /* it looks along y */
    adcgs_camera_path_free(&frames);
    adcgs_camera_path_request request = {.has_times = 1, .begin = 7.0, .end = 7.0};
    assert_int_equal(read_path("c.chan", &frames, &request), ADCGS_OK);
    assert_true(frames.frame[2].time == 7.0);
    adcgs_camera_path_free(&frames);
}

/* ---- USD ---- */

static void test_usd_again(void **state)
{
    adcgs_camera_key keys[KEYS];
    adcgs_camera_path frames;
    random_keys(keys, 0.1, 0);
    assert_int_equal(adcgs_camera_keys_write(keys, KEYS, 1, &info, 10.0, ADCGS_ROTATION_XYZ, in("a.usda"), &error), ADCGS_OK);
    read_good("a.usda", &frames);
    assert_true(frames.n == KEYS && frames.frame_rate == 10.0);
    for (int k = 0; k < KEYS; k++) {
        expect_same(&frames.frame[k].camera, &keys[k].frame.camera, 1e-12);
        assert_true(fabs(frames.frame[k].time - keys[k].frame.time) < 1e-12);
    }
    adcgs_camera_path_free(&frames);
}

/** A camera as other programs write it: under parents, by operations, with a changing lens, and among irrelevant data. */
static const char by_others[] =
    "#usda 1.0\n(\n    \"a [ comment\"\n    defaultPrim = \"root\"\n    doc = \"\"\"Blender v9 \"quoted\" {\"\"\"\n"
    "    metersPerUnit = 1\n    upAxis = \"Z\"\n    startTimeCode = 1\n    endTimeCode = 25\n    timeCodesPerSecond = 24\n"
    "    customLayerData = { string note = \"}\" }\n    subLayers = [@./a(b.usda@]\n)\n\n"
    "over \"World\" { double x = 1 }\n"
    "def Xform \"root\" (\n    customData = { dictionary Blender = { bool generated = 1 } }\n)\n{\n"
    "    token visibility\n    rel material:binding = </root/mat>\n    asset inputs:file = @./tex#1.png@\n"
    "    def Mesh \"m\"\n    {\n        point3f[] points = [(1, 2, 3), (4, 5, 6)]\n        int[] faceVertexCounts = [3]\n    }\n"
    "    def Xform \"rig\"\n    {\n"
    "        double3 xformOp:translate.timeSamples = {\n            1: (0, 0, 0),\n            25: (10, 0, 0),\n        }\n"
    "        float3 xformOp:rotateXYZ = (90, 0, 30) (\n            doc = \"angles\"\n        )\n"
    "        float3 xformOp:scale = (2, 2, 2)\n"
    "        uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:rotateXYZ\", \"xformOp:scale\"]\n"
    "        def Camera \"Camera\" (prepend apiSchemas = [\"X\"])\n        {\n"
    "            float2 clippingRange = (0.25, 100)\n            float focalLength.timeSamples = {\n"
    "                1: 50,\n                13: None,\n                25: 100,\n            }\n"
    "            float horizontalAperture = 36; float verticalAperture = 18\n"
    "            token projection = \"perspective\"\n            double3 xformOp:translate:up = (0, 1, 0)\n"
    "            uniform token[] xformOpOrder = [\"xformOp:translate:up\"]\n        }\n    }\n}\n";

static void test_usd_of_others(void **state)
{
    adcgs_camera_path frames;
    put_text("o.usda", by_others);
    read_good("o.usda", &frames);
    assert_true(frames.n == 25 && frames.frame_rate == 24.0);
    for (int i = 0; i < 25; i += 12) {
        const adcgs_camera *const c = &frames.frame[i].camera;
        const double degrees[3] = {90, 0, 30}, part = i / 24.0;
        double expected[12] = {0}, up[3] = {0, 2, 0}; /* the parent's scale moves its child, too */
        turned(expected, "xyz", degrees);
        for (int a = 0; a < 3; a++)
            expected[4 * a + 3] = expected[4 * a] * up[0] + expected[4 * a + 1] * up[1] + expected[4 * a + 2] * up[2] +
                                  (a == 0 ? 10.0 * part : 0.0);
        adcgs_pose_other_axes(expected);
        assert_true(pose_difference(c->cam_to_world, expected) < 1e-9);
        assert_true(c->width == 64 && c->height == 32 && c->near_plane == 0.25);
        const double fx = (50.0 + 50.0 * part) * 64 / 36;
        assert_true(fabs(c->fx - fx) < 1e-9 && fabs(c->fy - fx) < 1e-9 && c->cx == 32.0 && c->cy == 16.0);
        assert_true(fabs(frames.frame[i].time - (1.0 + i / 24.0)) < 1e-12);
    }
    adcgs_camera_path_free(&frames);
    /* A camera without attributes has USD's defaults, at the origin. */
    put_text("n.usda", "#usda 1.0\ndef Camera \"c\" {}\n");
    read_good("n.usda", &frames);
    assert_true(frames.n == 1 && frames.frame[0].camera.cam_to_world[10] == -1.0);
    assert_true(fabs(frames.frame[0].camera.fx - 50.0 * 64 / 20.955) < 1e-9 && frames.frame[0].camera.near_plane == 0.125);
    adcgs_camera_path_free(&frames);
}

static void test_bad(void **state)
{
#define CAMERA(text) "#usda 1.0\ndef Camera \"c\"\n{\n" text "}\n"
#define OPS(text) CAMERA(text "uniform token[] xformOpOrder = [\"xformOp:a\"]\n")
    static const struct {
        const char *name, *text, *why;
        adcgs_status status;
    } bad[] = {
        {"a.chan", "", "no frames", ADCGS_ERR_DATA},
        {"a.chan", "1 2 3\n", "line 1: expected a frame number", ADCGS_ERR_DATA},
        {"a.chan", "1 0 0 0 0 0 0\n2 0 0 0 x 0 0\n", "line 2: expected a frame number", ADCGS_ERR_DATA},
        {"a.chan", "1.5 0 0 0 0 0 0\n", "line 1: expected a frame number", ADCGS_ERR_DATA},
        {"a.chan", "1 0 0 0 0 0 0 50 1\n", "line 1: expected a frame number", ADCGS_ERR_DATA},
        {"a.chan", "1 0 0 0 0 0 nan\n", "line 1: expected a frame number", ADCGS_ERR_DATA},
        {"a.chan", "2 0 0 0 0 0 0\n2 0 0 0 0 0 0\n", "line 2: frame 2, expected one after 2", ADCGS_ERR_DATA},
        {"a.chan", "1 0 0 0 0 0 0 180\n", "line 1: a field of view of 180", ADCGS_ERR_DATA},
        {"a.chan", "1 0 0 0 0 0 0\n100000000 0 0 0 0 0 0\n", "frames requested", ADCGS_ERR_DATA},
        {"a.usda", "", "begins with #usda 1.0", ADCGS_ERR_DATA},
        {"a.usd", "PXR-USDC....", "binary USD", ADCGS_ERR_UNSUPPORTED},
        {"a.usda", "#usda 1.0\n", "no prim of type Camera", ADCGS_ERR_DATA},
        {"a.usda", "#usda 1.0\ndef Camera {}\n", "line 2: expected a text", ADCGS_ERR_DATA},
        {"a.usda", "#usda 1.0\ndef Camera \"c\"\n{\n", "line 4: expected '}'", ADCGS_ERR_DATA},
        {"a.usda", CAMERA("float focalLength = (1, 2\n"), "line 5: expected ')'", ADCGS_ERR_DATA},
        {"a.usda", CAMERA("float focalLength = x\n"), "line 4: expected numbers", ADCGS_ERR_DATA},
        {"a.usda", CAMERA("float focalLength = 0\n"), "a focal length of 0", ADCGS_ERR_DATA},
        {"a.usda", CAMERA("float focalLength.timeSamples = {2: 1, 1: 1}\n"), "ascending times", ADCGS_ERR_DATA},
        {"a.usda", CAMERA("float focalLength.timeSamples = {1: 1, 2: (1, 2)}\n"), "as many numbers", ADCGS_ERR_DATA},
        {"a.usda", CAMERA("token projection = \"orthographic\"\n"), "projection: expected \"persp", ADCGS_ERR_UNSUPPORTED},
        {"a.usda", OPS(""), "xformOp:a: named in xformOpOrder, but", ADCGS_ERR_DATA},
        {"a.usda", OPS("float xformOp:a = 1\n"), "xformOp:a: an operation that", ADCGS_ERR_UNSUPPORTED},
        {"a.usda", CAMERA("uniform token[] xformOpOrder = [\"!invert!xformOp:a\"]\n"), "!invert!", ADCGS_ERR_UNSUPPORTED},
        {"a.usda",
         CAMERA("matrix4d xformOp:transform = ((1,0,0,0),(1,1,0,0),(0,0,1,0),(0,0,0,1))\n"
                "uniform token[] xformOpOrder = [\"xformOp:transform\"]\n"),
         "the camera's pose", ADCGS_ERR_DATA},
        {"a.usda", "#usda 1.0\n(\n startTimeCode = 0\n endTimeCode = 1e12\n)\ndef Camera \"c\" {}\n", "frames requested",
         ADCGS_ERR_DATA},
        {"a.usda", "#usda 1.0\n(\n timeCodesPerSecond = 0\n)\ndef Camera \"c\" {}\n", "0 time codes", ADCGS_ERR_DATA},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        adcgs_camera_path_request request = {0};
        adcgs_camera_path frames;
        put_text(bad[i].name, bad[i].text);
        expect_error(read_path(bad[i].name, &frames, &request), bad[i].status, bad[i].name, bad[i].why);
        adcgs_camera_path_free(&frames);
    }
    adcgs_camera_key keys[KEYS];
    random_keys(keys, 0.1, 1);
    expect_error(adcgs_camera_keys_write(keys, KEYS, 0, &info, 10.0, ADCGS_ROTATION_XYZ, in("x.usdc"), &error),
                 ADCGS_ERR_UNSUPPORTED, "x.usdc", "expected .usda");
}

/* A file that is cut or changed anywhere gives an error or a path, and nothing else. */
static void test_damaged(void **state)
{
    char text[sizeof by_others];
    uint64_t seed = 17;
    for (int n = 0; n < 3000; n++) {
        adcgs_camera_path_request request = {0};
        adcgs_camera_path frames;
        memcpy(text, by_others, sizeof text);
        const size_t at = 9 + (size_t)(uniform(&seed) * (double)(sizeof text - 10));
        text[at] = n % 3 ? (char)(32 + (int)(95 * uniform(&seed))) : '\0';
        put_text("d.usda", text);
        (void)read_path("d.usda", &frames, &request);
        adcgs_camera_path_free(&frames);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_angles),    cmocka_unit_test(test_chan_again),    cmocka_unit_test(test_chan_by_hand),
        cmocka_unit_test(test_usd_again), cmocka_unit_test(test_usd_of_others), cmocka_unit_test(test_bad),
        cmocka_unit_test(test_damaged),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
