/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Pose outliers among twelve cameras around a ball: a camera that is turned or moved, two that are exchanged, one with another
 * lens. Nothing is reported if all are right, all are off, or the cameras are few.
 */
#include "config.h" /* for the declarations that it enables in system headers */

#include "ball.h"

#include "geometry/vector.h"
#include "init/pose_outlier.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <cmocka.h>

enum { CAMERAS = 12, SIDE = 72, PIXELS = SIDE * SIDE, ODD = 5 };

static adcgs_stereo_rig rig;
static adcgs_depths depths[CAMERAS];
static adcgs_error error;

/** A camera on an arc, looking at the ball. */
static void set_view(adcgs_stereo_view *v, int i)
{
    const double a = 2.0 * M_PI * (i - 0.5 * (CAMERAS - 1)) / (3 * CAMERAS), tilt = i % 2 ? 0.15 : -0.1;
    const double z[3] = {-cos(a) * cos(tilt), -sin(a) * cos(tilt), -sin(tilt)}, right[3] = {-sin(a), cos(a), 0.0};
    adcgs_v3_cross(z, right, v->rotation + 3);
    for (int k = 0; k < 3; k++) {
        v->rotation[k] = right[k];
        v->rotation[6 + k] = z[k];
        v->centre[k] = -4.0 * z[k];
    }
    v->fx = v->fy = 1.6 * SIDE;
    v->cx = v->cy = 0.5 * SIDE;
    v->w = v->h = SIDE;
}

/** The image of a camera, and its depths. */
static void render_ball(adcgs_stereo_camera *c, adcgs_depths *d)
{
    const adcgs_stereo_view *const v = &c->view;
    for (int i = 0; i < PIXELS; i++) {
        const double p[3] = {(i % SIDE + 0.5 - v->cx) / v->fx, (i / SIDE + 0.5 - v->cy) / v->fy, 1.0};
        double w[3], x[3];
        for (int a = 0; a < 3; a++)
            w[a] = v->rotation[a] * p[0] + v->rotation[3 + a] * p[1] + v->rotation[6 + a] * p[2];
        const double away = ball_hit(v->centre, w, x);
        for (uint32_t k = 0; k < 3; k++)
            c->background[4 * i + (int)k] = away > 0.0 ? (float)ball_shows(x, k) : 0.5f;
        c->background[4 * i + 3] = 1;
        d->inverse[i] = (float)(1.0 / fmax(away, 0.1));
        d->quality[i] = away > 0.0 ? ADCGS_DEPTH_STRONG : ADCGS_DEPTH_NONE;
    }
}

static int make_rig(void **state)
{
    (void)state;
    rig.n_cameras = CAMERAS;
    for (int i = 0; i < CAMERAS; i++) {
        adcgs_stereo_camera *const c = &rig.camera[i];
        c->background = adcgs_alloc(NULL, 4 * PIXELS, sizeof *c->background, &error);
        c->unstable = adcgs_alloc(NULL, PIXELS, 1, &error);
        depths[i] = (adcgs_depths){.view = &c->view, .w = SIDE, .h = SIDE, .step = 0.001};
        depths[i].inverse = adcgs_alloc(NULL, PIXELS, sizeof *depths[i].inverse, &error);
        depths[i].quality = adcgs_alloc(NULL, PIXELS, 1, &error);
        if (!c->background || !c->unstable || !depths[i].inverse || !depths[i].quality)
            return -1;
        c->view.pixels = c->background;
        c->first = 100 + (uint32_t)i;
        set_view(&c->view, i);
        render_ball(c, &depths[i]);
    }
    return 0;
}

static int free_rig(void **state)
{
    (void)state;
    for (int i = 0; i < CAMERAS; i++)
        adcgs_depths_clear(&depths[i]);
    adcgs_stereo_rig_clear(&rig);
    return 0;
}

/** Turns a camera about one of its own axes. */
static void turn(int i, int axis, double degrees)
{
    double *const r = rig.camera[i].view.rotation, one[3], angle = degrees * M_PI / 180.0;
    memcpy(one, r + 3 * axis, sizeof one);
    for (int k = 0; k < 3; k++)
        adcgs_v3_rotate(one, sin(angle), cos(angle), r + 3 * k);
}

/** Moves a camera along one of its own axes, by a share of the distance to the ball. */
static void move(int i, int axis, double share)
{
    for (int a = 0; a < 3; a++)
        rig.camera[i].view.centre[a] += 3.0 * share * rig.camera[i].view.rotation[3 * axis + a];
}

static void exchange(int i, int k)
{
    set_view(&rig.camera[i].view, k);
    set_view(&rig.camera[k].view, i);
}

/** Runs the check and restores all cameras. */
static adcgs_stereo ask(void)
{
    adcgs_stereo out = {.n_outliers = 0};
    assert_int_equal(adcgs_stereo_find_pose_outliers(&out, &rig, depths, NULL, &error), ADCGS_OK);
    for (int i = 0; i < CAMERAS; i++)
        set_view(&rig.camera[i].view, i);
    for (int i = 0; i < out.n_outliers; i++)
        print_message("view %u: off by %.2f pixels, rotation %.2f degrees, translation %.3f of the distance\n",
                      out.outlier[i].view, out.outlier[i].off, out.outlier[i].turned, out.outlier[i].moved);
    return out;
}

/** Expects one camera to be reported, with its error in pixels and, roughly, its rotation and translation. */
static void expect_one(double pixels, double degrees, double share)
{
    const adcgs_stereo out = ask();
    assert_int_equal(out.n_outliers, 1);
    assert_int_equal(out.outlier[0].view, 100 + ODD);
    assert_true(fabs(out.outlier[0].off - pixels) < 0.15 * pixels);
    assert_true(fabs(out.outlier[0].turned - degrees) < 0.5 + 0.4 * degrees); /* small translations and rotations look alike */
    assert_true(fabs(out.outlier[0].moved - share) < 0.05 + 0.1 * share);
}

static void test_one(void **state)
{
    static const double degrees[] = {1.0, 4.0, 20.0};
    const double focal = rig.camera[ODD].view.fx;
    (void)state;
    for (size_t i = 0; i < ADCGS_COUNTOF(degrees); i++) {
        turn(ODD, 1, degrees[i]); /* along the epipolar lines of its neighbours */
        expect_one(focal * tan(degrees[i] * M_PI / 180.0), degrees[i], 0.0);
    }
    turn(ODD, 0, 2.0); /* across them */
    expect_one(focal * tan(2.0 * M_PI / 180.0), 2.0, 0.0);
    move(ODD, 0, 0.1);
    expect_one(focal * 0.1, 0.0, 0.1);
}

static void test_two(void **state)
{
    (void)state;
    for (int k = 0; k < CAMERAS; k += 6) {
        exchange(ODD, k);
        const adcgs_stereo out = ask();
        assert_int_equal(out.n_outliers, 2);
        assert_int_equal(out.outlier[0].view + out.outlier[1].view, 200 + ODD + k);
    }
}

static void test_lens(void **state)
{
    (void)state;
    rig.camera[ODD].view.fx *= 1.1;
    rig.camera[ODD].view.fy *= 1.1;
    const adcgs_stereo out = ask();
    assert_int_equal(out.n_outliers, 1);
    assert_int_equal(out.outlier[0].view, 100 + ODD);
}

static void test_nothing(void **state)
{
    (void)state;
    assert_int_equal(ask().n_outliers, 0);
    for (int i = 0; i < CAMERAS; i++) /* then no single camera is an outlier */
        turn(i, i % 2, i % 3 - 1.0);
    assert_int_equal(ask().n_outliers, 0);
    turn(ODD, 1, 0.05); /* a sixth of a pixel */
    assert_int_equal(ask().n_outliers, 0);
    turn(2, 1, 5.0);
    rig.n_cameras = 4; /* too few cameras to decide which is right */
    assert_int_equal(ask().n_outliers, 0);
    rig.n_cameras = CAMERAS;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one),
        cmocka_unit_test(test_two),
        cmocka_unit_test(test_lens),
        cmocka_unit_test(test_nothing),
    };
    return cmocka_run_group_tests(tests, make_rig, free_rig);
}
