/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Filmed paths: chosen by the encoder, followed by a view; the filmed region; requests for a pivot. */
#include "play_rig.h"

#include "encode/filmed_path.h"
#include "encode/stored_cameras.h"
#include "geometry/rotation.h"
#include "play/by_hand.h"

#include <math.h>
#include <stdlib.h>

#define TURN 6.283185307179586

/** A camera on a circle of radius 6 about the origin, looking at it. */
static adcgs_camera camera_at(double angle)
{
    const double eye[3] = {6.0 * cos(angle), 6.0 * sin(angle), 1.0}, target[3] = {0, 0, 0}, up[3] = {0, 0, 1};
    adcgs_camera camera = make_camera();
    adcgs_look_at(camera.cam_to_world, eye, target, up);
    return camera;
}

static double way(const adcgs_camera *a, const adcgs_camera *b)
{
    double most = 0;
    for (int i = 0; i < 12; i++)
        most = fmax(most, fabs(a->cam_to_world[i] - b->cam_to_world[i]));
    return most;
}

/** Views of a walk along a quarter of the circle, with a stop in the middle; noise in radians is different in each. */
static void make_walk(adcgs_scene_view *views, int n, double noise)
{
    uint32_t random = 1;
    for (int i = 0; i < n; i++) {
        const double part = (double)i / (n - 1), pace = part < 0.4 ? part : part < 0.6 ? 0.4 : part - 0.2;
        random = random * 1664525u + 1013904223u;
        const double shake = noise * ((double)(random >> 8) / (1 << 24) - 0.5);
        views[i] = (adcgs_scene_view){.camera = camera_at(0.25 * TURN * pace + shake), .time = i / 30.0};
    }
}

static void test_path_has_few_keys(void **state)
{
    enum { N = 300 };
    static adcgs_scene_view views[N];
    adcgs_filmed_path path;
    adcgs_follow follow;
    adcgs_camera camera;
    make_walk(views, N, 0);
    assert_int_equal(adcgs_filmed_path_make(&path, views, N, 3.0, NULL), ADCGS_OK);
    assert_true(path.n >= 4 && path.n <= 16);
    assert_true(path.keys[0].at == 0.0 && path.keys[path.n - 1].at == views[N - 1].time);
    adcgs_filmed_camera *const stored = calloc((size_t)path.n, sizeof *stored);
    assert_non_null(stored);
    for (int i = 0; i < path.n; i++)
        stored[i] = (adcgs_filmed_camera){path.keys[i].frame.camera, path.keys[i].at, 0};
    assert_int_equal(adcgs_follow_init(&follow, stored, path.n, 0, NULL), ADCGS_OK);
    for (int i = 0; i < N; i++) {
        adcgs_follow_at(&follow, views[i].time, &camera);
        assert_true(way(&camera, &views[i].camera) < 0.06); /* 1.5 % of the image's width */
    }
    adcgs_follow_at(&follow, -5.0, &camera);
    assert_true(way(&camera, &views[0].camera) < 1e-6); /* binary32 */
    adcgs_follow_clear(&follow);
    assert_int_equal(adcgs_follow_init(&follow, stored, path.n, 1, NULL), ADCGS_OK);
    assert_int_equal(follow.spline.n, 0); /* there is no second path */
    adcgs_follow_clear(&follow);
    free(stored);
    adcgs_filmed_path_clear(&path);
}

/** A shaking hand makes no path of a hundred keys; single photographs make none. */
static void test_path_of_noise(void **state)
{
    enum { N = 300 };
    static adcgs_scene_view views[N];
    adcgs_filmed_path path;
    make_walk(views, N, 0.02);
    assert_int_equal(adcgs_filmed_path_make(&path, views, N, 3.0, NULL), ADCGS_OK);
    assert_true(path.n >= 4 && path.n <= 64);
    adcgs_filmed_path_clear(&path);
    make_walk(views, N, TURN);
    assert_int_equal(adcgs_filmed_path_make(&path, views, N, 3.0, NULL), ADCGS_OK);
    assert_int_equal(path.n, 0);
    adcgs_filmed_path_clear(&path);
    assert_int_equal(adcgs_filmed_path_make(&path, views, 1, 3.0, NULL), ADCGS_OK);
    assert_int_equal(path.n, 0);
    adcgs_filmed_path_clear(&path);
}

/* ---- Cameras of a stream. ---- */

enum { STEPS = 40 };

typedef struct walks {
    adcgs_scene scene;
    adcgs_scene_view views[2 * STEPS];
    char path[2 * STEPS][32];
} walks;

/** Two cameras that film at the same times: each walks, or stands. Their views alternate. */
static void make_scene(walks *w, const char *names[2], const int walk[2])
{
    static adcgs_scene_view film[STEPS];
    make_walk(film, STEPS, 0);
    memset(w, 0, sizeof *w);
    for (int i = 0; i < 2 * STEPS; i++) {
        const int who = i % 2;
        w->views[i] = film[i / 2];
        w->views[i].camera = walk[who] ? camera_at(0.3 * who + 0.02 * (i / 2)) : camera_at(2.0 + who);
        snprintf(w->path[i], sizeof w->path[i], "%s%03d.png", names[who], i / 2);
        w->views[i].path = w->path[i];
    }
    w->scene.views[ADCGS_SPLIT_TRAIN] = w->views;
    w->scene.n_views[ADCGS_SPLIT_TRAIN] = 2 * STEPS;
    w->scene.duration = STEPS / 30.0;
}

static void assert_stored(const walks *w, int cameras_least, int paths, int timed)
{
    adcgs_stream stream;
    int last = -1, with_time = 0;
    adcgs_stream_init(&stream);
    stream.scene_scale = 3.0;
    assert_int_equal(adcgs_stored_cameras_choose(&stream, &w->scene, NULL), ADCGS_OK);
    assert_true((int)stream.n_cameras >= cameras_least && stream.n_cameras <= 40);
    for (uint32_t i = 0; i < stream.n_cameras; i++) {
        const adcgs_stored_camera *const c = &stream.cameras[i];
        with_time += !isnan(c->time);
        assert_true(c->path < 0 || c->path == last || c->path == last + 1);
        assert_true(c->path < 0 || c->path != last || c->time > c[-1].time);
        last = c->path > last ? c->path : last;
    }
    assert_int_equal(last + 1, paths);
    assert_true(timed < 0 ? with_time == (int)stream.n_cameras : with_time == timed);
    adcgs_stream_clear(&stream, NULL);
}

static void test_stored_cameras(void **state)
{
    walks *const w = malloc(sizeof *w);
    assert_non_null(w);
    make_scene(w, (const char *[2]){"left/", "right/"}, (const int[2]){1, 1});
    assert_stored(w, 4, 2, -1);
    make_scene(w, (const char *[2]){"0_", "1_"}, (const int[2]){1, 1});
    assert_stored(w, 4, 2, -1);
    make_scene(w, (const char *[2]){"left/", "right/"}, (const int[2]){0, 0});
    assert_stored(w, 2, 0, 0); /* fixed cameras have no time, and each is stored once */
    w->scene.n_views[ADCGS_SPLIT_TRAIN] = 4;
    assert_stored(w, 2, 0, 0); /* also after two frames, as at the beginning of live footage */
    make_scene(w, (const char *[2]){"left/", "right/"}, (const int[2]){1, 0});
    assert_stored(w, 2, 1, -1);
    for (int i = 0; i < 2 * STEPS; i++) /* photographs from everywhere, at times of their own */
        w->views[i].camera = camera_at(2.39996 * i);
    assert_stored(w, 8, 0, -1);
    w->scene.duration = 0;
    assert_stored(w, 8, 0, 0);
    free(w);
}

/* ---- The view. ---- */

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_path_has_few_keys),
        cmocka_unit_test(test_path_of_noise),
        cmocka_unit_test(test_stored_cameras),
        cmocka_unit_test(test_view_follows),
        cmocka_unit_test(test_view_resists),
        cmocka_unit_test(test_view_returns),
        cmocka_unit_test(test_region),
        cmocka_unit_test(test_region_has_axes),
        cmocka_unit_test(test_drags_up_and_down),
        cmocka_unit_test(test_pivot_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
