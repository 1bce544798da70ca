/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Synthetic faults of filmed scenes: the effect of each, that it has no other effect, and invalid options. */
#include "synthetic/spoil.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const double pose[12] = {1, 0, 0, 0.5, 0, 0.8, -0.6, -3.0, 0, 0.6, 0.8, 2.0};

static adcgs_spoil_picture picture_at(int camera, int number)
{
    const adcgs_spoil_picture picture =
        {.camera = camera, .cameras = 12, .number = number, .width = 160, .time = number / 48.0, .step = 1.0 / 24.0};
    return picture;
}

static adcgs_spoil spoilt(const char *text)
{
    adcgs_spoil spoil;
    adcgs_error error;
    assert_int_equal(adcgs_spoil_parse(&spoil, text, &error), ADCGS_OK);
    return spoil;
}

/* Degrees by which a camera is turned. */
static double turned(const char *text, int camera, int number)
{
    const adcgs_spoil spoil = spoilt(text);
    const adcgs_spoil_picture picture = picture_at(camera, number);
    double m[12], trace = 0.0;
    memcpy(m, pose, sizeof m);
    adcgs_spoil_pose(&spoil, &picture, 200.0, m);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            trace += m[4 * r + c] * pose[4 * r + c];
    for (int r = 0; r < 3; r++)
        assert_true(m[4 * r + 3] == pose[4 * r + 3]); /* it stays in its place */
    return acos(fmin(0.5 * (trace - 1.0), 1.0)) * 57.29577951308232;
}

static void test_wrong_faults_are_refused(void **state)
{
    static const char *const bad[] = {"none=1",          "pose",     "pose=",   "pose=x",       "pose=-1", "pose=nan",
                                      "pose=101",        "axes=1.5", "axes=4",  "drop=1",       "pose=1,", ",",
                                      "pose=1;drop=0.1", "pos=1",    "poses=1", "pose,drop=0.1"};
    adcgs_spoil spoil;
    adcgs_error error;
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        assert_int_equal(adcgs_spoil_parse(&spoil, bad[i], &error), ADCGS_ERR_USAGE);
        assert_non_null(strstr(error.text, "spoil: "));
        assert_null(strchr(error.text, '\n'));
    }
    spoil = spoilt("pose=0.5,axes=3,after=0.9");
    assert_true(spoil.strength[ADCGS_SPOIL_POSE] == 0.5 && spoil.strength[ADCGS_SPOIL_AXES] == 3.0);
    assert_true(spoil.strength[ADCGS_SPOIL_AFTER] == 0.9 && spoil.strength[ADCGS_SPOIL_SYNC] == 0.0);
}

static void no_fault_changes_nothing(void **state)
{
    static const char *const none[] = {"", NULL, "pose=0,sync=0,exposure=0,axes=0"};
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(none); i++) {
        const adcgs_spoil spoil = spoilt(none[i]);
        for (int number = 0; number <= 48; number++) {
            const adcgs_spoil_picture picture = picture_at(number % 12, number);
            float rgb[3] = {0.1f, 0.7f, 1.0f};
            double m[12];
            memcpy(m, pose, sizeof m);
            adcgs_spoil_pose(&spoil, &picture, 200.0, m);
            adcgs_spoil_pixels(&spoil, &picture, rgb, 1);
            assert_memory_equal(m, pose, sizeof m);
            assert_true(rgb[0] == 0.1f && rgb[1] == 0.7f && rgb[2] == 1.0f);
            assert_true(!adcgs_spoil_hides(&spoil, &picture) && adcgs_spoil_time(&spoil, &picture) == picture.time);
        }
    }
}

static void cameras_are_turned_as_far_as_they_say(void **state)
{
    double camera = 0.0, shake = 0.0;
    (void)state;
    for (int i = 0; i < 48; i++) {
        assert_true(turned("pose=2", i % 12, i) == turned("pose=2", i % 12, i + 1)); /* always the same */
        assert_true(turned("shake=2", 3, i) != turned("shake=2", 3, i + 1));
        assert_true(fabs(turned("pose=4", i, i) / turned("pose=2", i, i) - 2.0) < 0.05);
        camera += turned("pose=2", i, i) / 48;
        shake += turned("shake=2", 0, i) / 48;
    }
    /* 2 of 200 pixels to two sides are 0.57 degrees each, 2 of 80 about the axis 1.43. */
    assert_true(camera > 1.0 && camera < 2.0 && shake > 1.0 && shake < 2.0);
    assert_true(fabs(turned("wrongpose=20", 6, 0) - 20.0) < 1e-6 && turned("wrongpose=20", 5, 0) < 1e-5);
}

/* Each convention applied twice gives the original. */
static void other_axes_are_others(void **state)
{
    static const char *const axes[] = {"axes=1", "axes=2", "axes=3"};
    const adcgs_spoil_picture picture = picture_at(0, 0);
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(axes); i++) {
        const adcgs_spoil spoil = spoilt(axes[i]);
        double m[12];
        memcpy(m, pose, sizeof m);
        adcgs_spoil_pose(&spoil, &picture, 200.0, m);
        assert_memory_not_equal(m, pose, sizeof m);
        adcgs_spoil_pose(&spoil, &picture, 200.0, m);
        for (int k = 0; k < 12; k++)
            assert_true(fabs(m[k] - pose[k]) < 1e-12);
    }
}

static void gains_are_a_cameras(void **state)
{
    const adcgs_spoil exposure = spoilt("exposure=1"), white = spoilt("white=1"), step = spoilt("step=1");
    const adcgs_spoil tint = spoilt("tint=2");
    double least = 9.0, most = 0.0;
    (void)state;
    for (int camera = 0; camera < 12; camera++) {
        const adcgs_spoil_picture early = picture_at(camera, 0), late = picture_at(camera, 24);
        float rgb[6] = {0.25f, 0.25f, 0.25f, 0.9f, 0.9f, 0.9f};
        float again[3] = {0.25f, 0.25f, 0.25f}, other[3] = {0.25f, 0.25f, 0.25f};
        adcgs_spoil_pixels(&exposure, &early, rgb, 2);
        adcgs_spoil_pixels(&exposure, &late, again, 1);
        adcgs_spoil_pixels(&white, &early, other, 1);
        assert_memory_equal(rgb, again, sizeof again);
        assert_true(rgb[0] == rgb[1] && rgb[0] == rgb[2] && rgb[3] <= 1.0f && other[0] != other[1]);
        least = fmin(least, (double)rgb[0]);
        most = fmax(most, (double)rgb[0]);
        other[0] = again[0] = 0.25f;
        adcgs_spoil_pixels(&step, &early, other, 1);
        adcgs_spoil_pixels(&step, &late, again, 1);
        assert_true(other[0] == 0.25f && fabsf(again[0] - 0.125f) < 1e-6f);
        again[0] = again[1] = again[2] = 0.25f;
        adcgs_spoil_pixels(&tint, &early, again, 1);
        assert_true(again[0] == 0.25f && again[2] == 0.25f);
        adcgs_spoil_pixels(&tint, &late, again, 1);
        assert_true(fabsf(again[0] - 0.5f) < 1e-6f && again[1] == 0.25f && fabsf(again[2] - 0.125f) < 1e-6f);
    }
    assert_true(least >= 0.125 && least < 0.2 && most > 0.33 && most <= 0.5);
}

static void times_are_others(void **state)
{
    const adcgs_spoil sync = spoilt("sync=2"), twice = spoilt("twice=0.25"), drop = spoilt("drop=0.25");
    const adcgs_spoil before = spoilt("before=0.25"), inside = spoilt("inside=0.25"), after = spoilt("after=0.25");
    int again = 0, gone = 0, hidden[3] = {0, 0, 0};
    double furthest = 0.0;
    (void)state;
    for (int i = 0; i < 480; i++) {
        adcgs_spoil_picture picture = picture_at(i % 12, i);
        picture.time = i % 24 / 23.0;
        picture.step = 1.0 / 23.0;
        const double off = adcgs_spoil_time(&sync, &picture) - picture.time;
        const double back = picture.time - adcgs_spoil_time(&twice, &picture);
        furthest = fmax(furthest, fabs(off));
        assert_true(back == 0.0 || fabs(back - picture.step) < 1e-12);
        again += back > 0.0;
        gone += adcgs_spoil_hides(&drop, &picture);
        hidden[0] += adcgs_spoil_hides(&before, &picture);
        hidden[1] += adcgs_spoil_hides(&inside, &picture);
        hidden[2] += adcgs_spoil_hides(&after, &picture);
        assert_int_equal(adcgs_spoil_hides(&before, &picture), picture.time < 0.25);
        assert_int_equal(adcgs_spoil_hides(&after, &picture), picture.time > 0.75);
    }
    assert_true(furthest > 1.0 / 23.0 && furthest <= 2.0 / 23.0 + 1e-12);
    assert_in_range(again, 80, 150);
    assert_in_range(gone, 90, 150);
    assert_true(hidden[0] == 120 && hidden[1] == 120 && hidden[2] == 120);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrong_faults_are_refused),
        cmocka_unit_test(no_fault_changes_nothing),
        cmocka_unit_test(cameras_are_turned_as_far_as_they_say),
        cmocka_unit_test(other_axes_are_others),
        cmocka_unit_test(gains_are_a_cameras),
        cmocka_unit_test(times_are_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
