/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Camera paths: flights through key frames, paths around the stored cameras, valid and invalid path files. */
#include "outside_files.h"

#include "camera/spline.h"
#include "geometry/rotation.h"

#include <math.h>

#define KEYS 6

static double uniform(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/** Rotation about an axis by an angle, at a position; a lens and a time of its own. */
static adcgs_camera_frame make_frame(const double axis[3], double angle, const double position[3], double focal, double time)
{
    adcgs_camera_frame frame =
        {.camera = {.width = 64, .height = 48, .fx = focal, .fy = 1.1 * focal, .cx = 30, .cy = 20, .near_plane = 0.1},
         .time = time};
    double unit[3] = {axis[0], axis[1], axis[2]}, q[4];
    adcgs_v3_normalise(unit);
    adcgs_rotation_exp(unit, 0.5 * angle, q);
    adcgs_rotation_to_pose(q, frame.camera.cam_to_world);
    for (int i = 0; i < 3; i++)
        frame.camera.cam_to_world[4 * i + 3] = position[i];
    return frame;
}

static void random_keys(adcgs_camera_key keys[KEYS], uint64_t seed)
{
    double at = -1.0;
    for (int k = 0; k < KEYS; k++) {
        double v[6];
        for (int i = 0; i < 6; i++)
            v[i] = 2.0 * uniform(&seed) - 1.0;
        at += 0.2 + uniform(&seed);
        keys[k] =
            (adcgs_camera_key){at, make_frame(v, 6.0 * uniform(&seed), v + 3, 50.0 + 20.0 * uniform(&seed), uniform(&seed))};
    }
}

/** Largest difference of two frames' numbers. */
static double difference(const adcgs_camera_frame *a, const adcgs_camera_frame *b)
{
    double worst = fmax(fabs(a->time - b->time), fabs(a->camera.fx - b->camera.fx));
    worst = fmax(worst, fmax(fabs(a->camera.fy - b->camera.fy), fabs(a->camera.cx - b->camera.cx)));
    for (int i = 0; i < 12; i++)
        worst = fmax(worst, fabs(a->camera.cam_to_world[i] - b->camera.cam_to_world[i]));
    return worst;
}

static void check_rotation(const double m[12])
{
    double x[3] = {m[0], m[4], m[8]}, y[3] = {m[1], m[5], m[9]}, z[3] = {m[2], m[6], m[10]}, cross[3];
    assert_true(fabs(adcgs_v3_dot(x, x) - 1.0) < 1e-12 && fabs(adcgs_v3_dot(y, y) - 1.0) < 1e-12);
    assert_true(fabs(adcgs_v3_dot(x, y)) < 1e-12);
    adcgs_v3_cross(x, y, cross);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(cross[i] - z[i]) < 1e-12);
}

/** Any rotation becomes a unit quaternion and is restored from it, half turns too. */
static void test_turns(void **state)
{
    uint64_t seed = 5;
    for (int n = 0; n < 300; n++) {
        double axis[3], q[4], pose[12], back[4], turn[3];
        const double angle = n % 3 ? 7.0 * uniform(&seed) : 3.14159265358979;
        for (int i = 0; i < 3; i++)
            axis[i] = n < 12 ? (n / 3 % 3 == i) : 2.0 * uniform(&seed) - 1.0;
        adcgs_v3_normalise(axis);
        adcgs_rotation_exp(axis, 0.5 * angle, q);
        adcgs_rotation_to_pose(q, pose);
        check_rotation(pose);
        adcgs_rotation_from_pose(pose, back);
        const double same = q[0] * back[0] + q[1] * back[1] + q[2] * back[2] + q[3] * back[3];
        assert_true(fabs(fabs(same) - 1.0) < 1e-12);
        const double one[4] = {1.0, 0.0, 0.0, 0.0};
        adcgs_rotation_between(one, q, turn);
        assert_true(sqrt(adcgs_v3_dot(turn, turn)) < 1.5707963267949 + 1e-9);
        adcgs_rotation_exp(turn, 1.0, back);
        const double whole = q[0] * back[0] + q[1] * back[1] + q[2] * back[2] + q[3] * back[3];
        assert_true(fabs(fabs(whole) - 1.0) < 1e-12);
    }
}

static void test_through_keys(void **state)
{
    for (int linear = 0; linear < 2; linear++)
        for (uint64_t seed = 1; seed < 20; seed++) {
            adcgs_camera_key keys[KEYS];
            adcgs_camera_spline spline;
            adcgs_camera_frame frame;
            random_keys(keys, seed);
            assert_int_equal(adcgs_camera_spline_init(&spline, keys, KEYS, linear, 0, &error), ADCGS_OK);
            for (int k = 0; k < KEYS; k++) {
                adcgs_camera_spline_at(&spline, keys[k].at, &frame);
                assert_true(difference(&frame, &keys[k].frame) < 1e-9);
            }
            adcgs_camera_spline_at(&spline, -100.0, &frame);
            assert_true(difference(&frame, &keys[0].frame) < 1e-9);
            adcgs_camera_spline_at(&spline, 100.0, &frame);
            assert_true(difference(&frame, &keys[KEYS - 1].frame) < 1e-9);
            adcgs_camera_spline_clear(&spline);
        }
}

/**
 * The pose is a rotation everywhere. Time and lens are within those of the neighbouring keys. Values do not jump, nor does the
 * speed of smooth paths.
 */
static void test_smooth(void **state)
{
    const double step = 1e-5;
    for (uint64_t seed = 1; seed < 20; seed++)
        for (int closed = 0; closed < 2; closed++) {
            adcgs_camera_key keys[KEYS];
            adcgs_camera_spline spline;
            adcgs_camera_frame s[4];
            random_keys(keys, seed);
            if (closed)
                keys[KEYS - 1].frame = keys[0].frame;
            assert_int_equal(adcgs_camera_spline_init(&spline, keys, KEYS, 0, closed, &error), ADCGS_OK);
            for (int k = 0; k + 1 < KEYS; k++)
                for (double t = 0.0; t <= 1.0; t += 0.05) {
                    const double a = keys[k].frame.time, b = keys[k + 1].frame.time;
                    adcgs_camera_spline_at(&spline, keys[k].at + t * (keys[k + 1].at - keys[k].at), &s[0]);
                    check_rotation(s[0].camera.cam_to_world);
                    assert_true(s[0].time >= fmin(a, b) - 1e-12 && s[0].time <= fmax(a, b) + 1e-12);
                }
            for (int k = 0; k < KEYS; k++) {
                const int wraps = k == 0 || k == KEYS - 1;
                if (wraps && !closed)
                    continue;
                const double before = k ? keys[k].at : keys[KEYS - 1].at, after = wraps ? keys[0].at : keys[k].at;
                adcgs_camera_spline_at(&spline, before - step, &s[0]);
                adcgs_camera_spline_at(&spline, before, &s[1]);
                adcgs_camera_spline_at(&spline, after, &s[2]);
                adcgs_camera_spline_at(&spline, after + step, &s[3]);
                for (int i = 0; i < 12; i++) {
                    const double come = (s[1].camera.cam_to_world[i] - s[0].camera.cam_to_world[i]) / step;
                    const double go = (s[3].camera.cam_to_world[i] - s[2].camera.cam_to_world[i]) / step;
                    assert_true(fabs(come - go) < 1e-2);
                }
                assert_true(fabs((s[1].time - s[0].time) - (s[3].time - s[2].time)) / step < 1e-2);
            }
            adcgs_camera_spline_clear(&spline);
        }
}

/** Equal steps between keys give a constant speed, in space and in angle. */
static void test_steady(void **state)
{
    const double axis[3] = {1.0, 2.0, -0.5};
    for (int linear = 0; linear < 2; linear++) {
        adcgs_camera_key keys[KEYS];
        adcgs_camera_spline spline;
        for (int k = 0; k < KEYS; k++) {
            const double position[3] = {0.5 * k, 1.0 - k, 2.0 * k};
            keys[k] = (adcgs_camera_key){2.0 * k, make_frame(axis, 0.9 * k, position, 50.0 + k, 0.1 * k)};
        }
        assert_int_equal(adcgs_camera_spline_init(&spline, keys, KEYS, linear, 0, &error), ADCGS_OK);
        for (double k = 0.0; k <= KEYS - 1; k += 0.0625) {
            const double position[3] = {0.5 * k, 1.0 - k, 2.0 * k};
            const adcgs_camera_frame expected = make_frame(axis, 0.9 * k, position, 50.0 + k, 0.1 * k);
            adcgs_camera_frame frame;
            adcgs_camera_spline_at(&spline, 2.0 * k, &frame);
            assert_true(difference(&frame, &expected) < 1e-9);
        }
        adcgs_camera_spline_clear(&spline);
    }
}

/** Values equal in two keys stay constant; a single key is a still image. */
static void test_standstill(void **state)
{
    adcgs_camera_key keys[KEYS];
    adcgs_camera_spline spline;
    adcgs_camera_frame frame;
    random_keys(keys, 3);
    const double first = keys[0].at;
    keys[3].frame = keys[2].frame;
    assert_int_equal(adcgs_camera_spline_init(&spline, keys, KEYS, 0, 0, &error), ADCGS_OK);
    for (double t = 0.0; t <= 1.0; t += 0.1) {
        adcgs_camera_spline_at(&spline, keys[2].at + t * (keys[3].at - keys[2].at), &frame);
        assert_true(difference(&frame, &keys[2].frame) < 1e-9);
    }
    adcgs_camera_spline_clear(&spline);
    assert_int_equal(adcgs_camera_spline_init(&spline, keys, 1, 0, 0, &error), ADCGS_OK);
    adcgs_camera_spline_at(&spline, first + 1.0, &frame);
    assert_true(difference(&frame, &keys[0].frame) < 1e-9);
    adcgs_camera_spline_clear(&spline);
}

/* ---- Around the stored cameras ---- */

/** Cameras on part of a circle around the focus, in a scrambled order, all looking at it. */
static void make_ring(adcgs_rig *rig, adcgs_camera *cameras, int n, double whole)
{
    *rig = (adcgs_rig){.n = n, .cameras = cameras, .focus = {1.0, -2.0, 0.5}, .distance = 3.0, .up = {0.0, 0.0, 1.0}};
    for (int c = 0; c < n; c++) {
        const double angle = whole * (c * 5 % n) / n;
        const double eye[3] = {1.0 + 3.0 * cos(angle), -2.0 + 3.0 * sin(angle), 0.5};
        cameras[c] = (adcgs_camera){.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 32, .cy = 24, .near_plane = 0.1};
        adcgs_look_at(cameras[c].cam_to_world, eye, rig->focus, rig->up);
    }
}

/** Sine of the angle between a camera's direction and the direction to the focus. */
static double off_focus(const adcgs_camera *camera, const double focus[3])
{
    const double *m = camera->cam_to_world;
    double to[3] = {focus[0] - m[3], focus[1] - m[7], focus[2] - m[11]}, ahead[3] = {m[2], m[6], m[10]}, cross[3];
    adcgs_v3_normalise(to);
    assert_true(adcgs_v3_dot(to, ahead) > 0.0);
    adcgs_v3_cross(to, ahead, cross);
    return sqrt(adcgs_v3_dot(cross, cross));
}

static double way(const adcgs_camera *a, const adcgs_camera *b)
{
    const double d[3] = {a->cam_to_world[3] - b->cam_to_world[3], a->cam_to_world[7] - b->cam_to_world[7],
                         a->cam_to_world[11] - b->cam_to_world[11]};
    return sqrt(adcgs_v3_dot(d, d));
}

static void test_bullet(void **state)
{
    for (int is_ring = 0; is_ring < 2; is_ring++) {
        adcgs_camera cameras[12];
        adcgs_rig rig;
        adcgs_camera_path frames;
        make_ring(&rig, cameras, 12, is_ring ? 6.283185307179586 : 2.0);
        assert_int_equal(adcgs_camera_path_alloc(&frames, 120, NULL, &error), ADCGS_OK);
        for (int s = 0; s < frames.n; s++)
            frames.frame[s].time = 0.75;
        assert_int_equal(adcgs_rig_bullet(&rig, &frames, &error), ADCGS_OK);
        const double step = is_ring ? 3.0 * 6.283185307179586 / 120 : 3.0 * 2.0 * 11 / 12 / 119;
        for (int s = 0; s < frames.n; s++) {
            const adcgs_camera *camera = &frames.frame[s].camera;
            check_rotation(camera->cam_to_world);
            assert_true(off_focus(camera, rig.focus) < 0.01 && frames.frame[s].time == 0.75);
            const double d[3] = {camera->cam_to_world[3] - 1.0, camera->cam_to_world[7] + 2.0, camera->cam_to_world[11] - 0.5};
            assert_true(fabs(sqrt(adcgs_v3_dot(d, d)) - 3.0) < 0.03);
            if (s + 1 < frames.n || is_ring)
                assert_true(fabs(way(camera, &frames.frame[(s + 1) % frames.n].camera) / step - 1.0) < 0.1);
        }
        adcgs_camera_path_free(&frames);
    }
}

/** Cameras all in one place have a path too. */
static void test_bullet_at_rest(void **state)
{
    adcgs_camera cameras[4];
    adcgs_rig rig;
    adcgs_camera_path frames;
    make_ring(&rig, cameras, 4, 0.0);
    assert_int_equal(adcgs_camera_path_alloc(&frames, 5, NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_rig_bullet(&rig, &frames, &error), ADCGS_OK);
    for (int s = 0; s < frames.n; s++)
        assert_true(way(&frames.frame[s].camera, &cameras[0]) < 1e-9);
    adcgs_camera_path_free(&frames);
}

static void test_spiral(void **state)
{
    /* An arc, whose mean is behind its middle; a ring, which has none; one camera. */
    for (int kind = 0; kind < 3; kind++) {
        adcgs_camera cameras[12];
        adcgs_rig rig;
        adcgs_camera_path frames;
        make_ring(&rig, cameras, kind == 2 ? 1 : 12, kind ? 6.283185307179586 : 1.0);
        assert_int_equal(adcgs_camera_path_alloc(&frames, 60, NULL, &error), ADCGS_OK);
        adcgs_rig_spiral(&rig, &frames);
        double focus[3], least = 1e9, most = 0.0;
        for (int i = 0; i < 3; i++) /* the first frame looks there from three units, plus or minus the radius */
            focus[i] = rig.focus[i];
        for (int s = 0; s < frames.n; s++) {
            const adcgs_camera *camera = &frames.frame[s].camera;
            check_rotation(camera->cam_to_world);
            assert_true(off_focus(camera, focus) < 0.05);
            least = fmin(least, way(camera, &frames.frame[0].camera));
            most = fmax(most, way(camera, &frames.frame[0].camera));
            assert_true(way(camera, &frames.frame[(s + 1) % frames.n].camera) < 0.4);
        }
        assert_true(most > 0.3 && most < 3.0);
        adcgs_camera_path_free(&frames);
    }
}

/* ---- Files ---- */

#define POSE "\"transform_matrix\": [[1,0,0,%g],[0,1,0,2],[0,0,1,3],[0,0,0,1]]"

static const adcgs_info info = {.time_start = 1.0, .time_end = 3.0, .frame_rate = 10.0, .scene_scale = 1.0};

static adcgs_status read_path(const char *text, adcgs_camera_path_request *request, adcgs_camera_path *frames)
{
    put_text("p.json", text);
    request->camera = in("p.json");
    *frames = (adcgs_camera_path){0};
    return adcgs_camera_path_read(frames, &info, request, &(adcgs_camera){.near_plane = 0.1}, &error);
}

static void test_key_file(void **state)
{
    adcgs_camera_path_request request = {0};
    adcgs_camera_path frames;
    char text[1024];
    snprintf(text, sizeof text,
             "{\"w\":64,\"h\":48,\"frame_rate\":4,\"interpolate\":\"linear\",\"keys\":["
             "{\"at\":2,\"fl_x\":50," POSE "},{\"at\":4,\"fl_x\":60," POSE "},{\"at\":5,\"fl_x\":60,\"time\":2.5," POSE "}]}",
             0.0, 1.0, 1.0);
    assert_int_equal(read_path(text, &request, &frames), ADCGS_OK);
    assert_true(frames.n == 13 && frames.frame_rate == 4.0);
    assert_true(frames.frame[4].camera.cam_to_world[3] == 0.5);
    assert_true(frames.frame[4].camera.fx == 55.0 && frames.frame[4].time == 2.0);
    assert_true(frames.frame[0].time == 1.0 && frames.frame[12].time == 2.5 && fabs(frames.frame[10].time - 2.75) < 1e-12);
    assert_true(frames.frame[0].camera.width == 64 && frames.frame[0].camera.height == 48);
    assert_true(frames.frame[0].camera.cam_to_world[5] == -1.0); /* OpenCV axes */
    adcgs_camera_path_free(&frames);
    request = (adcgs_camera_path_request){.has_times = 1, .begin = 1.5, .end = 1.5, .size = {128, 96}};
    assert_int_equal(read_path(text, &request, &frames), ADCGS_OK);
    assert_true(frames.frame[4].time == 1.5 && frames.frame[4].camera.width == 128 && frames.frame[4].camera.fx == 110.0);
    adcgs_camera_path_free(&frames);
}

static void test_bad_files(void **state)
{
    static const struct {
        const char *keys, *rest, *what, *why;
    } bad[] = {
        {"", "", "keys", "is empty"},
        {"3", "", "keys[0]", "expected an object"},
        {"{\"at\":0}", "", "keys[0].transform_matrix", "4 rows"},
        {"{@}", "", "keys[0].at", "missing"},
        {"{\"at\":\"now\",@}", "", "keys[0].at", "a number"},
        {"{\"at\":1e99,@}", "", "keys[0].at", "expected -1e+09"},
        {"{\"at\":1,@},{\"at\":1,@}", "", "keys[1].at", "more than the 1"},
        {"{\"at\":1,@},{\"at\":0,@}", "", "keys[1].at", "0, expected more"},
        {"{\"at\":0,\"w\":9,\"h\":9,@},{\"at\":1,@}", "", "keys[1].w", "one size"},
        {"{\"at\":0,@}", ",\"interpolate\":\"cubic\"", "interpolate", "\"smooth\" or \"linear\""},
        {"{\"at\":0,@}", ",\"interpolate\":7", "interpolate", "\"smooth\" or \"linear\""},
        {"{\"at\":0,@}", ",\"frame_rate\":0", "frame_rate", "expected 0.001"},
        {"{\"at\":0,@}", ",\"frames\":[]", "keys", "not both"},
        {"{\"at\":0,@},{\"at\":1e9,@}", "", "frames requested", "1000000"},
        {"{\"at\":0,\"time\":\"x\",@}", "", "keys[0].time", "a number"},
        {"{\"at\":0,\"fl_x\":-1,@}", "", "keys[0].fl_x", "expected"},
    };
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        adcgs_camera_path_request request = {0};
        adcgs_camera_path frames;
        char text[2048] = "{\"fl_x\":50,\"keys\":[", pose[128];
        snprintf(pose, sizeof pose, POSE, 0.0);
        for (const char *c = bad[i].keys; *c; c++) {
            const char one[2] = {*c, 0};
            strcat(text, *c == '@' ? pose : one);
        }
        strcat(text, "]");
        strcat(text, bad[i].rest);
        strcat(text, "}");
        expect_error(read_path(text, &request, &frames), ADCGS_ERR_DATA, bad[i].what, bad[i].why);
        adcgs_camera_path_free(&frames);
    }
}

/** Rendering cameras must be pinholes. */
static void test_bent_lenses(void **state)
{
    static const char *const bent[][2] = {{"\"k1\":0.1", "distortion 0.1"},
                                          {"\"is_fisheye\":true", "OPENCV_FISHEYE"},
                                          {"\"camera_model\":\"RADIAL_FISHEYE\"", "RADIAL_FISHEYE"}};
    for (size_t i = 0; i < ADCGS_COUNTOF(bent); i++) {
        adcgs_camera_path_request request = {0};
        adcgs_camera_path frames;
        char text[512], pose[128];
        snprintf(pose, sizeof pose, POSE, 0.0);
        snprintf(text, sizeof text, "{\"fl_x\":50,%s,\"keys\":[{\"at\":0,%s}]}", bent[i][0], pose);
        expect_error(read_path(text, &request, &frames), ADCGS_ERR_UNSUPPORTED, bent[i][1], "expected a pinhole camera");
        adcgs_camera_path_free(&frames);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turns),     cmocka_unit_test(test_through_keys),   cmocka_unit_test(test_smooth),
        cmocka_unit_test(test_steady),    cmocka_unit_test(test_standstill),     cmocka_unit_test(test_bullet),
        cmocka_unit_test(test_spiral),    cmocka_unit_test(test_bullet_at_rest), cmocka_unit_test(test_key_file),
        cmocka_unit_test(test_bad_files), cmocka_unit_test(test_bent_lenses),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
