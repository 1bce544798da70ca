/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player over time, without a window: interactive cameras, its clock, its resolution. */
#include "play_rig.h"

#include "camera/orbit_control.h"
#include "geometry/rotation.h"
#include "geometry/vector.h"
#include "play/play_state.h"
#include "play/scale.h"

#include <math.h>

static adcgs_orbit_control make_rig(const char *axes)
{
    const adcgs_info info = make_info(axes);
    const adcgs_camera camera = make_camera();
    adcgs_orbit_control control;
    adcgs_orbit_control_init(&control, &info, &camera);
    return control;
}

static void assert_rotation(const adcgs_orbit_control *control)
{
    double right[3], down[3], forward[3], third[3];
    column(control, 0, right);
    column(control, 1, down);
    column(control, 2, forward);
    adcgs_v3_cross(right, down, third);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(third[i] - forward[i]) < 1e-12);
    assert_true(fabs(adcgs_v3_dot(right, right) - 1.0) < 1e-12 && fabs(adcgs_v3_dot(down, down) - 1.0) < 1e-12);
    assert_true(fabs(adcgs_v3_dot(right, down)) < 1e-12);
}

static void test_orbit(void **state)
{
    adcgs_orbit_control control = make_rig("right-handed, z up");
    double right[3];
    for (int i = 0; i < 20000; i++) {
        adcgs_orbit_control_orbit(&control, 0.37 * sin(i), 0.11 * cos(3.0 * i));
        assert_rotation(&control);
    }
    assert_true(fabs(adcgs_orbit_control_distance(&control) - 6.0) < 1e-9);
    assert_true(looks_at(&control, control.centre) > 1.0 - 1e-12);
    column(&control, 0, right);
    assert_true(fabs(right[2]) < 1e-9); /* the horizon stays level */
    /* Dragging down shows the scene from above, at most from straight above. */
    adcgs_orbit_control_orbit(&control, 0.0, -10.0);
    assert_true(control.camera.cam_to_world[11] > 3.0 + 6.0 * 0.999);
    assert_true(looks_at(&control, control.centre) > 1.0 - 1e-12);
    adcgs_orbit_control_orbit(&control, 0.0, 20.0);
    assert_true(control.camera.cam_to_world[11] < 3.0 - 6.0 * 0.999);
    assert_rotation(&control);
}

static void test_orbit_follows_mouse(void **state)
{
    adcgs_orbit_control control = make_rig("right-handed, z up");
    adcgs_orbit_control_orbit(&control, -0.1, 0.0); /* dragged to the right: the camera goes left, -x */
    assert_true(fabs(control.camera.cam_to_world[3] - (1.0 - 6.0 * sin(0.1))) < 1e-12);
    assert_true(fabs(control.camera.cam_to_world[7] - (2.0 - 6.0 * cos(0.1))) < 1e-12);
    control = make_rig("right-handed, z up");
    adcgs_orbit_control_look(&control, -0.1, 0.0); /* turns to the right, +x, in place */
    assert_true(fabs(control.camera.cam_to_world[2] - sin(0.1)) < 1e-12);
    assert_true(control.camera.cam_to_world[3] == 1.0 && control.camera.cam_to_world[7] == -4.0 &&
                control.camera.cam_to_world[11] == 3.0);
}

static void test_up(void **state)
{
    assert_true(make_rig("right-handed, z up").up[2] == 1.0);
    assert_true(make_rig("right-handed, y up").up[1] == 1.0);
    assert_true(make_rig("right-handed, y down").up[1] == -1.0);
    /* Without axes in the stream, the camera's up counts: here +z, then +x after a tilt by a quarter turn. */
    adcgs_info info = make_info("unknown");
    adcgs_camera camera = make_camera();
    adcgs_orbit_control control = make_rig("unknown");
    assert_true(control.up[2] == 1.0);
    const double tilted[12] = {0, -1, 0, 1.0, 0, 0, 1, -4.0, -1, 0, 0, 3.0};
    memcpy(camera.cam_to_world, tilted, sizeof tilted);
    adcgs_orbit_control_init(&control, &info, &camera);
    assert_true(control.up[0] == 1.0);
}

static void test_pan_and_zoom(void **state)
{
    adcgs_orbit_control control = make_rig("right-handed, z up");
    adcgs_orbit_control_orbit(&control, 0.5, 0.3);
    const adcgs_orbit_control before = control;
    double right[3], down[3];
    column(&control, 0, right);
    column(&control, 1, down);
    adcgs_orbit_control_pan(&control, 0.1, -0.05);
    assert_true(fabs(adcgs_orbit_control_distance(&control) - 6.0) < 1e-12);
    assert_true(looks_at(&control, control.target) > 1.0 - 1e-12);
    /* The old target is now at the dragged place: right by 0.1 focal lengths, up by 0.05. */
    double to[3];
    for (int i = 0; i < 3; i++)
        to[i] = before.target[i] - control.camera.cam_to_world[4 * i + 3];
    assert_true(fabs(adcgs_v3_dot(to, right) / 6.0 - 0.1) < 1e-12 && fabs(adcgs_v3_dot(to, down) / 6.0 + 0.05) < 1e-12);
    adcgs_orbit_control_zoom(&control, 3.0);
    assert_true(fabs(adcgs_orbit_control_distance(&control) - 6.0 * 0.729) < 1e-12);
    adcgs_orbit_control_zoom(&control, -3.0);
    assert_true(fabs(adcgs_orbit_control_distance(&control) - 6.0) < 1e-9);
    adcgs_orbit_control_zoom(&control, 1e9);
    assert_true(adcgs_orbit_control_distance(&control) > 0.0 && adcgs_orbit_control_distance(&control) < 0.01);
    for (int i = 0; i < 300; i++)
        adcgs_orbit_control_zoom(&control, -1e3); /* the distance has a limit */
    assert_true(adcgs_orbit_control_distance(&control) < 3e5 * 3.0 + 10.0);
    assert_rotation(&control);
}

static void test_fly(void **state)
{
    adcgs_orbit_control control = make_rig("right-handed, z up");
    adcgs_orbit_control_fly(&control, 1.0, 0.0, 2.0); /* units of 3 */
    assert_true(control.camera.cam_to_world[3] == 4.0 && control.camera.cam_to_world[7] == 2.0 &&
                control.camera.cam_to_world[11] == 3.0);
    assert_memory_equal(control.target, control.centre, sizeof control.target);
    adcgs_orbit_control_look(&control, 0.3, 0.1);
    adcgs_orbit_control_land(&control);
    assert_true(looks_at(&control, control.target) > 1.0 - 1e-12);
    const adcgs_camera camera = make_camera();
    adcgs_orbit_control_jump(&control, &camera);
    assert_memory_equal(&control.camera, &camera, sizeof camera);
    assert_memory_equal(control.target, control.centre, sizeof control.target);
}

static void test_view(void **state)
{
    const adcgs_orbit_control control = make_rig("right-handed, z up");
    adcgs_camera view, again = control.camera;
    adcgs_orbit_control_view(&control, 640, 480, &view);
    assert_memory_equal(&view, &control.camera, sizeof view);
    adcgs_orbit_control_view(&control, 1920, 1440, &view); /* the same aspect: equal to stretching, to the last bit */
    adcgs_camera_stretch(&again, 1920, 1440);
    assert_memory_equal(&view, &again, sizeof view);
    adcgs_orbit_control_view(&control, 1000, 480, &view); /* enlarged, with 135 pixels less above and below */
    assert_true(view.fx == 781.25 && view.fy == 796.875 && view.cx == 468.75 && view.cy == 255.625);
    assert_true(adcgs_orbit_control_inset(&control, 1000, 480, 0) == 0.0);
    adcgs_orbit_control_view(&control, 320, 480, &view); /* 160 pixels less at both sides */
    assert_true(view.fx == 500.0 && view.fy == 510.0 && view.cx == 140.0 && view.cy == 250.0);
    adcgs_orbit_control_view(&control, 3000, 480, &view); /* half of the height, and 860 pixels more at both sides */
    assert_true(view.fx == 1000.0 && view.fy == 1020.0 && view.cx == 1460.0 && view.cy == 260.0);
    assert_true(fabs(adcgs_orbit_control_inset(&control, 3000, 480, 0) - 860.0 / 3000.0) < 1e-12);
    assert_true(adcgs_orbit_control_inset(&control, 3000, 480, 1) == 0.0);
    adcgs_orbit_control_view(&control, 160, 480, &view); /* half of the width, and 120 pixels more above and below */
    assert_true(view.fx == 250.0 && view.cx == 70.0 && view.cy == 245.0);
    assert_true(fabs(adcgs_orbit_control_inset(&control, 160, 480, 1) - 0.25) < 1e-12);
    view = control.camera;
    adcgs_camera_fit(&view, 320, 480, 1); /* nothing more above and below, 160 pixels less at both sides */
    assert_true(view.fx == 500.0 && view.fy == 510.0 && view.cx == 140.0 && view.cy == 250.0 && view.width == 320);
    adcgs_camera_fit(&view, 640, 480, 0); /* and back */
    assert_memory_equal(&view, &control.camera, sizeof view);
}

static void test_clock(void **state)
{
    adcgs_play_clock clock;
    adcgs_play_clock_init(&clock, 2.0, 2.9, 10.0, 100.0);
    assert_int_equal(clock.frames, 10);
    adcgs_play_clock_tick(&clock, 105.0); /* paused: nothing happens */
    assert_true(adcgs_play_clock_time(&clock) == 2.0);
    adcgs_play_clock_toggle(&clock);
    adcgs_play_clock_tick(&clock, 105.05);
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
    adcgs_play_clock_tick(&clock, 105.45); /* 0.4 s without a tick still advance by four frames */
    assert_int_equal(adcgs_play_clock_frame(&clock), 4);
    assert_true(adcgs_play_clock_time(&clock) == 2.0 + 4 / 10.0);
    assert_int_equal(adcgs_play_clock_dropped(&clock, 0, 4), 3);
    assert_int_equal(adcgs_play_clock_dropped(&clock, 3, 4), 0);
    assert_int_equal(adcgs_play_clock_dropped(&clock, 8, 1), 2);
    adcgs_play_clock_tick(&clock, 106.05); /* 1.05 s after its start: past the end */
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
    clock.loop = 0;
    adcgs_play_clock_tick(&clock, 206.0);
    assert_int_equal(adcgs_play_clock_frame(&clock), 9);
    assert_false(clock.playing);
    adcgs_play_clock_toggle(&clock); /* from the end it plays from the beginning */
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
    adcgs_play_clock_tick(&clock, 205.0); /* a clock that goes back stands still */
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
}

/** While a stream is still arriving, playing waits at its current end and continues when more arrives. */
static void test_clock_waits(void **state)
{
    adcgs_play_clock clock;
    adcgs_play_clock_init(&clock, 1.0, INFINITY, 10.0, 0.0);
    assert_true(clock.frames > 1000000);
    adcgs_play_clock_toggle(&clock);
    assert_false(adcgs_play_clock_waits(&clock));
    clock.available = -INFINITY;
    assert_true(adcgs_play_clock_waits(&clock));
    adcgs_play_clock_tick(&clock, 3.0);
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
    clock.available = 0.4;
    adcgs_play_clock_tick(&clock, 3.2);
    assert_int_equal(adcgs_play_clock_frame(&clock), 2);
    adcgs_play_clock_tick(&clock, 9.0);
    assert_true(adcgs_play_clock_waits(&clock) && clock.playing);
    assert_int_equal(adcgs_play_clock_frame(&clock), 4);
    clock.available = INFINITY;
    adcgs_play_clock_tick(&clock, 9.1);
    assert_int_equal(adcgs_play_clock_frame(&clock), 5);
    adcgs_play_clock_span(&clock, 1.0, 1.3); /* the stream is shorter than expected */
    assert_int_equal(clock.frames, 4);
    assert_int_equal(adcgs_play_clock_frame(&clock), 3);
}

static void test_clock_speed(void **state)
{
    adcgs_play_clock clock;
    adcgs_play_clock_init(&clock, 0.0, 99.9, 10.0, 0.0);
    adcgs_play_clock_toggle(&clock);
    adcgs_play_clock_faster(&clock, 9);
    assert_true(adcgs_play_clock_factor(&clock) == 8.0);
    adcgs_play_clock_tick(&clock, 2.0);
    assert_int_equal(adcgs_play_clock_frame(&clock), 160);
    adcgs_play_clock_faster(&clock, -9);
    assert_true(adcgs_play_clock_factor(&clock) == 0.125);
    adcgs_play_clock_tick(&clock, 10.0);
    assert_int_equal(adcgs_play_clock_frame(&clock), 170);
}

static void test_clock_steps(void **state)
{
    adcgs_play_clock clock;
    adcgs_play_clock_init(&clock, 1.0 / 3.0, 1.0 / 3.0 + 299 / 29.97, 29.97, 0.0);
    assert_int_equal(clock.frames, 300);
    for (int i = 0; i < 300; i++) { /* each frame is hit exactly */
        assert_int_equal(adcgs_play_clock_frame(&clock), i);
        assert_true(adcgs_play_clock_time(&clock) == 1.0 / 3.0 + i / 29.97);
        adcgs_play_clock_step(&clock, 1);
    }
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
    adcgs_play_clock_step(&clock, -1);
    assert_int_equal(adcgs_play_clock_frame(&clock), 299);
    clock.loop = 0;
    adcgs_play_clock_step(&clock, 5);
    assert_int_equal(adcgs_play_clock_frame(&clock), 299);
    adcgs_play_clock_seek(&clock, 0.5);
    assert_int_equal(adcgs_play_clock_frame(&clock), 150);
    adcgs_play_clock_seek(&clock, -3.0);
    assert_int_equal(adcgs_play_clock_frame(&clock), 0);
    adcgs_play_clock_seek(&clock, 7.0);
    assert_int_equal(adcgs_play_clock_frame(&clock), 299);
    adcgs_play_clock_init(&clock, 5.0, 5.0, 30.0, 0.0); /* a single frame never plays */
    adcgs_play_clock_toggle(&clock);
    adcgs_play_clock_step(&clock, 1);
    assert_true(!clock.playing && clock.frames == 1 && adcgs_play_clock_time(&clock) == 5.0);
}

/** Plays images that take `seconds` each at full resolution, `base` of it at any size. \return changes of divider. */
static int play_pictures(adcgs_play_scale *scale, double base, double seconds, int pictures)
{
    int changes = 0;
    for (int i = 0; i < pictures; i++) {
        const int before = scale->divider;
        adcgs_play_scale_took(scale, base + (seconds - base) / (before * before), 1.0 / 30.0);
        changes += scale->divider != before;
    }
    return changes;
}

static void test_scale(void **state)
{
    adcgs_play_scale scale;
    adcgs_play_scale_init(&scale, 1);
    assert_int_equal(play_pictures(&scale, 0.0, 0.030, 100), 0); /* fits */
    adcgs_play_scale_took(&scale, 0.2, 1.0 / 30.0);              /* one slow image changes nothing */
    assert_int_equal(play_pictures(&scale, 0.0, 0.030, 100), 0);
    play_pictures(&scale, 0.0, 0.2, 100);
    assert_int_equal(scale.divider, 3);                         /* 22 ms; 50 at 1/2 */
    assert_int_equal(play_pictures(&scale, 0.0, 0.2, 1000), 0); /* and stays */
    play_pictures(&scale, 0.0, 0.01, 100);
    assert_int_equal(scale.divider, 1);
    play_pictures(&scale, 0.05, 1.0, 100); /* nothing helps: the coarsest, not beyond */
    assert_int_equal(scale.divider, ADCGS_PLAY_DIVIDER_MAX);
}

/** For any rendering times the resolution settles: it never oscillates. */
static void test_scale_settles(void **state)
{
    for (int base = 0; base <= 30; base += 5)
        for (int full = base; full < 400; full += 3) {
            adcgs_play_scale scale;
            adcgs_play_scale_init(&scale, 1);
            play_pictures(&scale, 1e-3 * base, 1e-3 * full, 200);
            assert_int_equal(play_pictures(&scale, 1e-3 * base, 1e-3 * full, 1000), 0);
        }
}

/**
 * At a quarter of the resolution the player drops tiers, one by one, then pixels again. They come back in reverse, without
 * oscillation.
 */
static void test_scale_tiers(void **state)
{
    (void)state;
    for (int full = 5; full < 2000; full += 15) {
        adcgs_play_scale scale;
        int changes = 0;
        adcgs_play_scale_init(&scale, 4);
        for (int i = 0; i < 1200; i++) {
            const adcgs_play_scale before = scale;
            double seconds = 1e-3 * full / (scale.divider * scale.divider);
            for (int t = scale.tiers; t < 4; t++)
                seconds *= 0.5;
            adcgs_play_scale_took(&scale, seconds, 1.0 / 30.0);
            changes += i >= 200 && (before.divider != scale.divider || before.tiers != scale.tiers);
            assert_true(scale.tiers >= 1 && scale.tiers <= 4 && (scale.tiers == 4 || scale.divider >= 4));
            assert_true(scale.divider <= 4 || scale.tiers == 1);
        }
        assert_int_equal(changes, 0);
        assert_true(scale.tiers == 4 || 1e-3 * full / 16 > 2.9 / 30.0); /* a sharp image may take longer */
        for (int i = 0; i < 200; i++)
            adcgs_play_scale_took(&scale, 1e-4, 1.0 / 30.0);
        assert_true(scale.divider == 1 && scale.tiers == 4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orbit),       cmocka_unit_test(test_orbit_follows_mouse),
        cmocka_unit_test(test_up),          cmocka_unit_test(test_pan_and_zoom),
        cmocka_unit_test(test_fly),         cmocka_unit_test(test_view),
        cmocka_unit_test(test_clock),       cmocka_unit_test(test_clock_waits),
        cmocka_unit_test(test_clock_speed), cmocka_unit_test(test_clock_steps),
        cmocka_unit_test(test_scale),       cmocka_unit_test(test_scale_settles),
        cmocka_unit_test(test_scale_tiers),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
