/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Views next to a filmed path: they follow, resist, return and loop; the filmed region; requests for a pivot. */
#include "film_rig.h"
#include "second_sources.h"

#include "play/by_hand.h"

#include <math.h>

typedef struct film {
    adcgs_filmed_camera cameras[5];
    adcgs_filmed_view filmed;
    adcgs_play_state play;
    adcgs_info info;
} film;

/** A player of a stream whose camera moved by 0.4 radians in a second. */
static void open_film(film *f)
{
    f->info = make_info("right-handed, z up");
    memset(f->info.scene_origin, 0, sizeof f->info.scene_origin);
    f->info.cameras = 5;
    f->info.time_start = 0.0;
    f->info.time_end = 1.0;
    for (int i = 0; i < 5; i++)
        f->cameras[i] = (adcgs_filmed_camera){camera_at(0.1 * i), 0.25 * i, 0};
    assert_int_equal(adcgs_filmed_view_init(&f->filmed, &f->info, f->cameras, &f->cameras[0].camera, NULL), ADCGS_OK);
    adcgs_play_init(&f->play, &f->info, &f->cameras[0].camera, f->cameras, &f->filmed);
    adcgs_play_resize(&f->play, 640, 480, 1.0);
    adcgs_play_tick(&f->play, 50.0);
}

static void go_to(film *f, double part)
{
    adcgs_play_clock_seek(&f->play.clock, part);
    adcgs_play_tick(&f->play, f->play.now + 0.01);
}

static void drag(film *f, double dx, double dy)
{
    const adcgs_event down = {.kind = ADCGS_EVENT_BUTTON, .button = 1, .down = 1, .x = 300, .y = 200};
    adcgs_play_event(&f->play, &down);
    adcgs_play_event(&f->play, &(adcgs_event){.kind = ADCGS_EVENT_MOTION, .dx = dx, .dy = dy});
    adcgs_play_event(&f->play, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = 1});
}

static void test_view_follows(void **state)
{
    film f;
    open_film(&f);
    assert_true(f.filmed.following && f.play.follows_home);
    for (int i = 0; i <= 4; i++) {
        go_to(&f, 0.25 * i);
        const adcgs_camera exact = camera_at(0.4 * adcgs_play_clock_time(&f.play.clock));
        assert_true(way(&f.play.control.camera, &exact) < 1e-3);
    }
    /* Turned by hand, the view keeps its place relative to the path: the same turn about the origin everywhere. */
    go_to(&f, 0);
    drag(&f, 20, 0);
    const double angle = atan2(f.play.control.camera.cam_to_world[7], f.play.control.camera.cam_to_world[3]);
    assert_true(fabs(angle) > 0.1 && f.filmed.beside);
    go_to(&f, 1);
    const double later = atan2(f.play.control.camera.cam_to_world[7], f.play.control.camera.cam_to_world[3]);
    assert_true(fabs(later - angle - 0.4 * adcgs_play_clock_time(&f.play.clock)) < 1e-3);
    /* c returns to the path, and then leaves the view where it is. */
    adcgs_play_event(&f.play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'c', .down = 1});
    const adcgs_camera end = camera_at(0.4 * adcgs_play_clock_time(&f.play.clock));
    assert_true(way(&f.play.control.camera, &end) < 1e-3 && !f.filmed.beside);
    adcgs_play_event(&f.play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'c', .down = 1});
    go_to(&f, 0);
    assert_true(way(&f.play.control.camera, &end) < 1e-3 && !f.filmed.following);
    adcgs_play_event(&f.play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'r', .down = 1});
    assert_true(way(&f.play.control.camera, &f.cameras[0].camera) < 1e-9 && f.filmed.following);
    adcgs_filmed_view_clear(&f.filmed);
}

static void test_view_resists(void **state)
{
    film f;
    double last = 0;
    open_film(&f);
    for (int i = 0; i < 200; i++) {
        drag(&f, 30, 0);
        assert_true(adcgs_play_outside(&f.play) >= last - 1e-12);
        last = adcgs_play_outside(&f.play);
        f.play.now += 1;
    }
    assert_true(last > 0.8 && last <= 1.0 + 1e-9);
    drag(&f, -30, 0); /* the way back is free */
    assert_true(adcgs_play_outside(&f.play) < last - 0.1);
    adcgs_play_event(&f.play, &(adcgs_event){.kind = ADCGS_EVENT_KEY, .key = 'x', .down = 1});
    const double angle = atan2(f.play.control.camera.cam_to_world[7], f.play.control.camera.cam_to_world[3]);
    drag(&f, 160, 0);
    const double free_angle = atan2(f.play.control.camera.cam_to_world[7], f.play.control.camera.cam_to_world[3]);
    assert_true(fabs(fabs(remainder(free_angle - angle, TURN)) - 1.0) < 1e-6); /* 3 radians per height */
    assert_true(adcgs_play_outside(&f.play) == 0.0);
    adcgs_filmed_view_clear(&f.filmed);
}

static double angle_of(const film *f)
{
    return atan2(f->play.control.camera.cam_to_world[7], f->play.control.camera.cam_to_world[3]);
}

/** Plays at a place of the film for some seconds. The view moves without a jump, and keeps its distance to the centre. */
static void play_at(film *f, double part, double seconds)
{
    const double *const pose = f->play.control.camera.cam_to_world;
    go_to(f, part);
    f->play.clock.playing = 1;
    for (int i = 0; i < 100 * seconds; i++) {
        const double before = angle_of(f);
        adcgs_play_clock_seek(&f->play.clock, part);
        adcgs_play_tick(&f->play, f->play.now + 0.01);
        assert_true(fabs(angle_of(f) - before) < 0.05);
        assert_true(fabs(sqrt(pose[3] * pose[3] + pose[7] * pose[7] + pose[11] * pose[11]) - sqrt(37.0)) < 1e-6);
    }
    f->play.clock.playing = 0;
}

/** While it plays, a view next to the path comes into the filmed region, and returns to its place where that is inside again. */
static void test_view_returns(void **state)
{
    const adcgs_event down = {.kind = ADCGS_EVENT_BUTTON, .button = 1, .down = 1, .x = 300, .y = 200};
    film f;
    open_film(&f);
    drag(&f, -96, 0); /* 0.6 radians: 0.2 beyond the path's end */
    const double placed = angle_of(&f);
    assert_true(placed > 0.5 && adcgs_play_outside(&f.play) == 0);
    go_to(&f, 1);
    const double later = angle_of(&f), outside = adcgs_play_outside(&f.play);
    assert_true(later > placed + 0.2 && outside > 0.2); /* paused, it keeps its offset */
    adcgs_play_event(&f.play, &down);
    play_at(&f, 1, 1);
    assert_true(fabs(angle_of(&f) - later) < 1e-9); /* held, too */
    adcgs_play_event(&f.play, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = 1});
    play_at(&f, 1, 4);
    assert_true(adcgs_play_outside(&f.play) < 1e-3 && angle_of(&f) < later - 0.1 && angle_of(&f) > placed);
    play_at(&f, 0, 4);
    assert_true(fabs(angle_of(&f) - placed) < 1e-3);
    f.filmed.unlimited = 1;
    play_at(&f, 1, 4);
    assert_true(fabs(angle_of(&f) - later) < 1e-3);
    adcgs_filmed_view_clear(&f.filmed);
}

/** In a loop, the view eases from the path's end to its start; where the user goes, it is at once. */
static void test_view_loops(void **state)
{
    const double step = 0.01, whole = 0.4; /* radians from the first frame to the last */
    film f;
    open_film(&f);
    go_to(&f, 1);
    const double end = angle_of(&f);
    f.play.clock.playing = 1;
    double last = end, fastest = 0;
    while (!f.play.clock.turns)
        adcgs_play_tick(&f.play, f.play.now + step);
    assert_true(fabs(end - whole) < 1e-3 && fabs(angle_of(&f) - end) < 1e-6);
    while (adcgs_play_clock_frame(&f.play.clock) < 6) {
        adcgs_play_tick(&f.play, f.play.now + step);
        fastest = fmax(fastest, fabs(angle_of(&f) - last));
        last = angle_of(&f);
        assert_true(adcgs_play_outside(&f.play) == 0.0);
    }
    const adcgs_camera filmed = camera_at(0.4 * adcgs_play_clock_time(&f.play.clock));
    assert_true(fastest > 0.01 && fastest < 0.4 * whole); /* the frames have steps of 0.1 seconds */
    assert_true(way(&f.play.control.camera, &filmed) < 1e-3);
    while (f.play.clock.turns < 2)
        adcgs_play_tick(&f.play, f.play.now + step);
    assert_true(angle_of(&f) > 0.9 * whole);
    go_to(&f, 0);
    assert_true(way(&f.play.control.camera, &f.cameras[0].camera) < 1e-6);
    adcgs_filmed_view_clear(&f.filmed);
}

/** An orbit of 20 degrees about the pivot stays in the region; steps forward cost less than steps back. */
static void test_region(void **state)
{
    const adcgs_filmed_camera one = {camera_at(0), (double)NAN, -1};
    adcgs_view_limit limit;
    assert_int_equal(adcgs_view_limit_init(&limit, &one, 1, NULL, NULL, sqrt(37.0), NULL), ADCGS_OK);
    assert_true(adcgs_view_limit_at(&limit, one.camera.cam_to_world) < 1e-6);
    assert_true(adcgs_view_limit_at(&limit, camera_at(20 * TURN / 360).cam_to_world) < 1);
    assert_true(adcgs_view_limit_at(&limit, camera_at(30 * TURN / 360).cam_to_world) > 1);
    adcgs_camera near = one.camera, far = one.camera;
    near.cam_to_world[3] -= 2;
    far.cam_to_world[3] += 3;
    assert_true(adcgs_view_limit_at(&limit, near.cam_to_world) < 1 && adcgs_view_limit_at(&limit, far.cam_to_world) > 1);
    adcgs_view_limit_clear(&limit);
    assert_int_equal(adcgs_view_limit_init(&limit, NULL, 0, NULL, NULL, 6.0, NULL), ADCGS_OK);
    assert_true(adcgs_view_limit_at(&limit, far.cam_to_world) == 0.0); /* without cameras there is no limit */
    adcgs_view_limit_clear(&limit);
}

/** Cameras far apart on a circle, all at one height: as free sideways as before, but not up, down, nor away from the centre. */
static void test_region_has_axes(void **state)
{
    static const double up[3] = {0, 0, 1};
    adcgs_filmed_camera ring[6];
    adcgs_view_limit limit;
    for (int i = 0; i < 6; i++)
        ring[i] = (adcgs_filmed_camera){camera_at(TURN * i / 6), (double)NAN, -1};
    assert_int_equal(adcgs_view_limit_init(&limit, ring, 6, NULL, up, sqrt(37.0), NULL), ADCGS_OK);
    adcgs_camera aside = ring[0].camera, high = aside, low = aside, far = aside;
    aside.cam_to_world[7] += 3;
    high.cam_to_world[11] += 3;
    low.cam_to_world[11] -= 1.2;
    far.cam_to_world[3] += 3;
    assert_true(adcgs_view_limit_at(&limit, aside.cam_to_world) < 1 && adcgs_view_limit_at(&limit, low.cam_to_world) > 2);
    assert_true(adcgs_view_limit_at(&limit, high.cam_to_world) > 1 && adcgs_view_limit_at(&limit, far.cam_to_world) > 1);
    adcgs_view_limit_clear(&limit);
    assert_int_equal(adcgs_view_limit_init(&limit, ring, 6, NULL, NULL, sqrt(37.0), NULL), ADCGS_OK);
    assert_true(adcgs_view_limit_at(&limit, low.cam_to_world) < 1); /* without up nothing is below */
    adcgs_view_limit_clear(&limit);
}

/** The longest drags end above the cameras, and at the level of the centre, which no camera saw from below. */
static void test_drags_up_and_down(void **state)
{
    double ends[2];
    film f;
    for (int way = 0; way < 2; way++) {
        open_film(&f);
        for (int i = 0; i < 300; i++) {
            drag(&f, 0, way ? 30 : -30);
            f.play.now += 1;
        }
        ends[way] = asin(f.play.control.camera.cam_to_world[11] / sqrt(37.0)) * 360 / TURN;
        adcgs_filmed_view_clear(&f.filmed);
    }
    const double highest = fmax(ends[0], ends[1]);
    assert_true(fabs(fmin(ends[0], ends[1])) < 2 && highest > 40 && highest < 60); /* degrees */
}

/** A double click asks for the pivot there; an answer to an older request is ignored. */
static void test_pivot_request(void **state)
{
    const double first[3] = {0.5, 0, 0}, second[3] = {0, 0.25, 0};
    film f;
    open_film(&f);
    assert_int_equal(f.play.pivots, 1);
    adcgs_play_pivot(&f.play, 1, first);
    assert_memory_equal(f.play.control.target, first, sizeof first);
    for (int i = 0; i < 2; i++) {
        const adcgs_event down = {.kind = ADCGS_EVENT_BUTTON, .button = 1, .down = 1, .x = 160, .y = 120};
        adcgs_play_event(&f.play, &down);
        adcgs_play_event(&f.play, &(adcgs_event){.kind = ADCGS_EVENT_BUTTON, .button = 1, .x = 160, .y = 120});
    }
    assert_true(f.play.pivot_at[0] == 0.25 && f.play.pivot_at[1] == 0.25);
    adcgs_play_pivot(&f.play, f.play.pivots - 1, first);
    adcgs_play_pivot(&f.play, f.play.pivots, second);
    assert_true(f.play.control.target[1] == 0.25);
    const int asked = f.play.pivots;
    drag(&f, 5, 0); /* no longer a click, and the chosen pivot stays */
    assert_int_equal(f.play.pivots, asked);
    adcgs_filmed_view_clear(&f.filmed);
}

int adcgs_test_filmed_views(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_view_follows),      cmocka_unit_test(test_view_resists),  cmocka_unit_test(test_view_returns),
        cmocka_unit_test(test_view_loops),        cmocka_unit_test(test_region),        cmocka_unit_test(test_region_has_axes),
        cmocka_unit_test(test_drags_up_and_down), cmocka_unit_test(test_pivot_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
