/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The player without a window: interactive cameras, its clock, resolution, events, scripts, letters. */
#include "outside_files.h"

#include "camera/rotation.h"
#include "play/actions.h"
#include "play/overlay.h"
#include "play/panel.h"
#include "play/play_state.h"
#include "play/scale.h"
#include "play/script.h"

#include <math.h>

/** A stream of 10 frames from second 2 on. Its scene has a scale of 3 units about (1, 2, 3). */
static adcgs_info make_info(const char *axes)
{
    adcgs_info info = {.time_start = 2.0,
                       .time_end = 2.9,
                       .frame_rate = 10.0,
                       .scene_origin = {1.0, 2.0, 3.0},
                       .scene_scale = 3.0,
                       .layers = 5,
                       .cameras = 2};
    snprintf(info.axes, sizeof info.axes, "%s", axes);
    return info;
}

/** A camera at a distance of 6 from the centre, looking at it along +y, z up. */
static adcgs_camera make_camera(void)
{
    return (adcgs_camera){.width = 640,
                          .height = 480,
                          .fx = 500.0,
                          .fy = 510.0,
                          .cx = 300.0,
                          .cy = 250.0,
                          .near_plane = 0.03,
                          .cam_to_world = {1, 0, 0, 1.0, 0, 0, 1, -4.0, 0, -1, 0, 3.0},
                          .name = "first"};
}

static adcgs_orbit_control make_rig(const char *axes)
{
    const adcgs_info info = make_info(axes);
    const adcgs_camera camera = make_camera();
    adcgs_orbit_control control;
    adcgs_orbit_control_init(&control, &info, &camera);
    return control;
}

static void column(const adcgs_orbit_control *control, int c, double v[3])
{
    for (int i = 0; i < 3; i++)
        v[i] = control->camera.cam_to_world[4 * i + c];
}

/** Cosine of the angle between the view and the direction to a point. */
static double looks_at(const adcgs_orbit_control *control, const double point[3])
{
    double forward[3], to[3];
    column(control, 2, forward);
    column(control, 3, to);
    for (int i = 0; i < 3; i++)
        to[i] = point[i] - to[i];
    return adcgs_v3_dot(forward, to) / sqrt(adcgs_v3_dot(to, to));
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
    adcgs_orbit_control_view(&control, 1000, 480, &view); /* 180 pixels more at both sides */
    assert_true(view.fx == 500.0 && view.fy == 510.0 && view.cx == 480.0 && view.cy == 250.0);
    adcgs_orbit_control_view(&control, 320, 480, &view); /* half the size, 120 more above and below */
    assert_true(view.fx == 250.0 && view.fy == 255.0 && view.cx == 150.0 && view.cy == 245.0);
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
 * At half the resolution the player drops tiers, one by one, then pixels again. They come back in reverse, without oscillation.
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
            assert_true(scale.tiers >= 1 && scale.tiers <= 4 && (scale.tiers == 4 || scale.divider >= 2));
            assert_true(scale.divider <= 2 || scale.tiers == 1);
        }
        assert_int_equal(changes, 0);
        for (int i = 0; i < 200; i++)
            adcgs_play_scale_took(&scale, 1e-4, 1.0 / 30.0);
        assert_true(scale.divider == 1 && scale.tiers == 4);
    }
}

static adcgs_play_state make_state(const adcgs_camera cameras[2])
{
    const adcgs_info info = make_info("right-handed, z up");
    const adcgs_camera home = make_camera();
    adcgs_play_state play;
    adcgs_play_init(&play, &info, &home, cameras);
    adcgs_play_resize(&play, 640, 480, 1.0);
    adcgs_play_tick(&play, 50.0);
    return play;
}

static void key(adcgs_play_state *play, int code)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = code, .down = 1});
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = code});
}

static void button(adcgs_play_state *play, int which, int down, double x, double y)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = which, .down = down, .x = x, .y = y});
}

static void motion(adcgs_play_state *play, double x, double y, double dx, double dy)
{
    adcgs_play_event(play, &(adcgs_event){.kind = ADCGS_EVENT_MOTION, .x = x, .y = y, .dx = dx, .dy = dy});
}

static void test_keys(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    cameras[1].cam_to_world[3] = 7.0;
    adcgs_play_state play = make_state(cameras);
    key(&play, ' ');
    assert_true(play.clock.playing && adcgs_play_moving(&play));
    key(&play, ADCGS_KEY_RIGHT);
    assert_true(!play.clock.playing && adcgs_play_clock_frame(&play.clock) == 1);
    key(&play, ADCGS_KEY_END);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 9);
    key(&play, 'l');
    assert_false(play.clock.loop);
    for (int i = 0; i < 9; i++)
        key(&play, '-');
    assert_int_equal(play.layers, 1);
    key(&play, '=');
    assert_int_equal(play.layers, 2);
    key(&play, '1');
    assert_true(play.jumped == 1 && play.control.camera.cam_to_world[3] == 7.0);
    key(&play, ']');
    assert_int_equal(play.jumped, 0);
    key(&play, '[');
    assert_int_equal(play.jumped, 1);
    key(&play, '7'); /* no such camera */
    assert_true(play.jumped == 1 && strstr(play.message, "2 cameras"));
    key(&play, 'r');
    assert_true(play.jumped == -1 && play.control.camera.cam_to_world[3] == 1.0);
    key(&play, 'p');
    assert_int_equal(play.shot, ADCGS_SOURCE_IMAGE_PNG);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_SHIFT, .down = 1});
    key(&play, 'p');
    assert_int_equal(play.shot, ADCGS_SOURCE_IMAGE_EXR);
    key(&play, 'k'); /* with shift, still */
    assert_int_equal(play.key_frame, -1);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_SHIFT, .down = 0});
    key(&play, 'k');
    assert_int_equal(play.key_frame, 1);
    key(&play, 'v');
    assert_true(play.record);
    key(&play, 'v');
    assert_false(play.record);
    key(&play, ADCGS_KEY_F11);
    key(&play, 'h');
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.help && play.full && !play.quit);
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.full && !play.quit);
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(play.quit);
}

/** q quits, except in flight, where it moves down. */
static void test_quit(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    key(&play, 'f');
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'q', .down = 1});
    assert_true(play.held && !play.quit);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'q', .down = 0});
    key(&play, 'f');
    key(&play, 'q');
    assert_true(play.quit);
}

/** A held key repeats single steps, and nothing else. */
static void test_repeats(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    for (int i = 0; i < 3; i++) {
        adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'i', .down = 1, .again = i > 0});
        adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = ADCGS_KEY_RIGHT, .down = 1, .again = i > 0});
    }
    assert_true(play.statistics && adcgs_play_clock_frame(&play.clock) == 3);
}

static void test_mouse(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    const adcgs_orbit_control before = play.control;
    motion(&play, 10, 10, 10, 10); /* without a button nothing moves */
    assert_memory_equal(&play.control, &before, sizeof before);
    assert_false(adcgs_play_moving(&play));
    button(&play, 1, 1, 100, 100);
    motion(&play, 200, 100, 100, 0);
    assert_true(adcgs_play_moving(&play) && fabs(adcgs_orbit_control_distance(&play.control) - 6.0) < 1e-12);
    assert_true(play.control.camera.cam_to_world[3] < 1.0 && looks_at(&play.control, play.control.centre) > 1.0 - 1e-12);
    assert_string_equal(play.control.camera.name, ""); /* no longer the first camera */
    button(&play, 1, 0, 200, 100);
    adcgs_play_tick(&play, 51.0);
    assert_false(adcgs_play_moving(&play));
    key(&play, 'r');
    button(&play, 3, 1, 100, 100); /* the point under the pointer stays there: 50 pixels of 500 at a depth of 6 */
    motion(&play, 150, 100, 50, 0);
    button(&play, 3, 0, 150, 100);
    assert_true(fabs(play.control.camera.cam_to_world[3] - (1.0 - 0.6)) < 1e-12);
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_WHEEL, .dy = 1.0});
    assert_true(fabs(adcgs_orbit_control_distance(&play.control) - 5.4) < 1e-9);
}

static void test_scrub(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    const adcgs_orbit_control before = play.control;
    const adcgs_rect bar = adcgs_play_bar(&play);
    assert_true(bar.width > 400 && bar.y + bar.height == 480);
    button(&play, 1, 1, bar.width - 1, bar.y + 3);
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 9);
    motion(&play, bar.width / 3.0, 20, -9, -9); /* the bar is still dragged, wherever the pointer is */
    assert_int_equal(adcgs_play_clock_frame(&play.clock), 3);
    button(&play, 1, 0, 0, 20);
    assert_memory_equal(&play.control, &before, sizeof before);
    key(&play, 'b');
    assert_int_equal(adcgs_play_bar(&play).width, 0);
}

static void test_flight(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    adcgs_play_state play = make_state(cameras);
    key(&play, 'f');
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'w', .down = 1});
    adcgs_play_tick(&play, 50.5); /* half a second at one scene unit per second: 1.5 along +y */
    assert_true(fabs(play.control.camera.cam_to_world[7] + 2.5) < 1e-12 && adcgs_play_moving(&play));
    adcgs_play_event(&play, &(adcgs_event){.kind = ADCGS_EVENT_LOST}); /* losing the focus releases all keys */
    adcgs_play_tick(&play, 55.0);
    assert_true(fabs(play.control.camera.cam_to_world[7] + 2.5) < 1e-12);
    motion(&play, 0, 0, 16, 0);
    assert_true(play.control.camera.cam_to_world[2] > 0.05); /* turns to the right */
    key(&play, ADCGS_KEY_ESCAPE);
    assert_true(!play.flying && !play.quit);
}

/* ---- Letters and panels. ---- */

static uint32_t pixel(const adcgs_panel *panel, int x, int y)
{
    const uint8_t *p = panel->rgba + 4 * (y * panel->width + x);
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static void test_letters(void **state)
{
    static const char picture[] = "..#..."
                                  ".#.#.."
                                  "#...#."
                                  "#...#."
                                  "#####."
                                  "#...#."
                                  "#...#."
                                  "......"
                                  "......";
    adcgs_panel panel = {0};
    adcgs_panel_init(&panel, 60, 40, 0x01020304);
    adcgs_panel_text(&panel, 3, 5, 2, "\nA", 0xa0b0c0d0);
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 60; x++) {
            const int column = (x - 3) / 2, row = (y - 5 - 2 * ADCGS_CELL_HEIGHT) / 2;
            const int inside = x >= 3 && y >= 5 + 2 * ADCGS_CELL_HEIGHT && column < 6 && row < 9;
            assert_int_equal(pixel(&panel, x, y), inside && picture[6 * row + column] == '#' ? 0xa0b0c0d0 : 0x01020304);
        }
    /* Nothing is written beyond the edges: the sanitizers watch. */
    adcgs_panel_text(&panel, -7, -5, 3, "cut off on all sides\nyes\nyes\nyes", 1);
    adcgs_panel_fill(&panel, -100, -100, 1000, 1000, 0xffffffff);
    assert_int_equal(pixel(&panel, 59, 39), 0xffffffff);
    adcgs_panel_init(&panel, 100000, 1, 0);
    assert_int_equal(panel.width, 0);
    adcgs_panel_free(&panel);
    for (int c = ' ' + 1; c < 127; c++) /* all letters exist, and no two are equal */
        for (int d = c + 1; d < 127; d++)
            assert_memory_not_equal(adcgs_glyph((char)c), adcgs_glyph((char)d), ADCGS_GLYPH_HEIGHT);
    assert_ptr_equal(adcgs_glyph((char)0xe4), adcgs_glyph('?'));
    assert_ptr_equal(adcgs_glyph('\t'), adcgs_glyph('?'));
}

static void test_overlay(void **state)
{
    adcgs_camera cameras[2] = {make_camera(), make_camera()};
    const adcgs_play_figures figures = {.seconds = 0.01, .width = 640, .height = 480};
    adcgs_play_state play = make_state(cameras);
    adcgs_panel panels[ADCGS_PANELS] = {{0}};
    int shown = 0;
    adcgs_overlay_draw(panels, &play, &figures);
    for (int i = 0; i < ADCGS_PANELS; i++)
        shown += panels[i].width > 0;
    assert_int_equal(shown, 1); /* the bar */
    key(&play, 'i');
    key(&play, 'h');
    adcgs_play_say(&play, "%s", "a word");
    for (int size = 64; size < 2000; size += 97) { /* in a window of any size, panels begin inside it */
        adcgs_play_resize(&play, size, 2100 - size, 1.0 + size / 700);
        adcgs_overlay_draw(panels, &play, &figures);
        for (int i = 0; i < ADCGS_PANELS; i++)
            assert_true(panels[i].width > 0 && panels[i].x >= 0 && panels[i].y >= 0 && panels[i].x < size);
    }
    adcgs_play_resize(&play, 640, 480, 1.0);
    adcgs_play_tick(&play, 60.0);
    adcgs_overlay_draw(panels, &play, &figures);
    assert_int_equal(panels[2].width, 0);    /* the message is gone */
    for (int i = 0; i < ADCGS_PANELS; i++) { /* at this size everything is visible */
        assert_true(panels[i].x + panels[i].width <= 640 && panels[i].y + panels[i].height <= 480);
        adcgs_panel_free(&panels[i]);
    }
}

/* ---- Scripts. ---- */

static adcgs_status read_script(adcgs_script *script, const char *text)
{
    FILE *file = fopen(in("a.script"), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return adcgs_script_read(script, in("a.script"), &error);
}

static void test_script(void **state)
{
    adcgs_script script;
    assert_int_equal(read_script(&script, "\xef\xbb\xbf# a word\n\n wait 10 frames\r\nwait 0.5 seconds\n"
                                          "drag shift-left 1 2 3.5 -4\nkey shift-p\nkey f1\n"
                                          "size 640x480\nexpect time 0.5 1e-3\nexpect size 64x65\nquit"),
                     ADCGS_OK);
    assert_int_equal(script.n, 9);
    const adcgs_script_line *const l = script.lines;
    assert_true(l[0].line == 3 && l[0].kind == ADCGS_SCRIPT_WAIT_FRAMES && l[0].number[0] == 10.0);
    assert_true(l[1].kind == ADCGS_SCRIPT_WAIT_SECONDS && l[1].number[0] == 0.5);
    assert_true(l[2].kind == ADCGS_SCRIPT_DRAG && l[2].shift && l[2].key == 1 && l[2].number[3] == -4.0);
    assert_true(l[3].key == 'p' && l[3].shift && l[4].key == ADCGS_KEY_F1 && !l[4].shift);
    assert_true(l[5].number[0] == 640.0 && l[5].number[1] == 480.0);
    assert_true(!strcmp(l[6].text, "time") && l[6].number[0] == 0.5 && l[6].number[1] == 1e-3);
    assert_true(l[7].number[1] == 65.0 && l[8].kind == ADCGS_SCRIPT_QUIT);
    adcgs_script_clear(&script);
    assert_int_equal(read_script(&script, "wait 3 bytes\nwait 2 tiers\nwait 4 segments\nwait end\n"), ADCGS_OK);
    assert_true(script.n == 4 && script.lines[0].kind == ADCGS_SCRIPT_WAIT_BYTES && script.lines[0].number[0] == 3.0);
    assert_true(script.lines[1].kind == ADCGS_SCRIPT_WAIT_TIERS && script.lines[2].kind == ADCGS_SCRIPT_WAIT_SEGMENTS);
    assert_true(script.lines[3].kind == ADCGS_SCRIPT_WAIT_END);
    adcgs_script_clear(&script);
}

static void test_bad_scripts(void **state)
{
    static const char *const bad[] = {"jump",
                                      "wait",
                                      "wait 3",
                                      "wait end 3",
                                      "wait 3 end",
                                      "wait -1 frames",
                                      "wait x frames",
                                      "drag left 1 2 3",
                                      "key",
                                      "drag nose 1 2 3 4",
                                      "key enter2",
                                      "key shift-",
                                      "size 10x10",
                                      "size 640",
                                      "size 640x480x3",
                                      "size 1e5x70",
                                      "screenshot",
                                      "grab a b",
                                      "expect",
                                      "expect time",
                                      "expect time 1 2 3",
                                      "expect size 3",
                                      "quit now",
                                      "wheel nan",
                                      "wheel 1e300",
                                      "move 1"};
    for (size_t i = 0; i < ADCGS_COUNTOF(bad); i++) {
        adcgs_script script;
        char text[100];
        snprintf(text, sizeof text, "quit\n%s\nquit\n", bad[i]);
        if (read_script(&script, text) != ADCGS_ERR_USAGE)
            fail_msg("\"%s\" was accepted as a command", bad[i]);
        assert_non_null(strstr(error.text, "a.script: line 2 is no command"));
        assert_null(script.lines);
    }
    adcgs_script script;
    assert_int_equal(adcgs_script_read(&script, in("none"), &error), ADCGS_ERR_IO);
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
        cmocka_unit_test(test_scale_tiers), cmocka_unit_test(test_keys),
        cmocka_unit_test(test_quit),        cmocka_unit_test(test_repeats),
        cmocka_unit_test(test_mouse),       cmocka_unit_test(test_scrub),
        cmocka_unit_test(test_flight),      cmocka_unit_test(test_letters),
        cmocka_unit_test(test_overlay),     cmocka_unit_test(test_script),
        cmocka_unit_test(test_bad_scripts),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
