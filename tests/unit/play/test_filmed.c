/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Filmed paths and stored cameras, chosen by the encoder. */
#include "film_rig.h"
#include "second_sources.h"

#include "encode/filmed_path.h"
#include "encode/stored_cameras.h"

#include <math.h>
#include <stdlib.h>

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_path_has_few_keys),
        cmocka_unit_test(test_path_of_noise),
        cmocka_unit_test(test_stored_cameras),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    return failed + adcgs_test_filmed_views();
}
