/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The visual hull of silhouettes: of a ball seen from all sides, and of views without evidence. */
#include "init/hull.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

enum { VIEWS = 4, WIDTH = 120, HEIGHT = 100, FOCAL = 100, PLANE = WIDTH * HEIGHT };
#define AWAY 1.5
#define RADIUS 0.3

static const double centre[3] = {0.1, -0.05, 0.2};
static adcgs_stereo_view views[VIEWS];
static uint8_t mask[VIEWS][PLANE];
static float pixels[VIEWS][4 * PLANE];
static const adcgs_stereo_point like = {.t = 0.25f, .moves = 1};
static adcgs_error error;

/** Views about the z axis, a quarter turn apart, that look at it. Each sees another grey. */
static int put_views(void **state)
{
    for (int i = 0; i < VIEWS; i++) {
        const double angle = i * acos(0), c = cos(angle), s = sin(angle);
        views[i] = (adcgs_stereo_view){.rotation = {-s, c, 0, 0, 0, -1, -c, -s, 0},
                                       .centre = {AWAY * c, AWAY * s, 0},
                                       .fx = FOCAL,
                                       .fy = FOCAL,
                                       .cx = WIDTH / 2,
                                       .cy = HEIGHT / 2,
                                       .w = WIDTH,
                                       .h = HEIGHT,
                                       .pixels = pixels[i]};
        for (int k = 0; k < 4 * PLANE; k++)
            pixels[i][k] = k % 4 == 3 ? 1 : 0.2f * (float)(i + 1);
    }
    return 0;
}

/** True if the ray of a pixel meets the ball. */
static int meets(const adcgs_stereo_view *v, int px, int py)
{
    double along = 0, to2 = 0, x[3], ray2 = 0;
    adcgs_stereo_rig_lift(v, px, py, 1, x);
    for (int a = 0; a < 3; a++) {
        const double ray = x[a] - v->centre[a], to = centre[a] - v->centre[a];
        along += ray * to;
        to2 += to * to;
        ray2 += ray * ray;
    }
    return to2 - along * along / ray2 < RADIUS * RADIUS;
}

static void put_ball(void)
{
    for (int i = 0; i < VIEWS; i++)
        for (int k = 0; k < PLANE; k++)
            mask[i][k] = (uint8_t)meets(&views[i], k % WIDTH, k / WIDTH);
}

static adcgs_stereo_list find(int n)
{
    const uint8_t *const moves[VIEWS] = {mask[0], mask[1], mask[2], mask[3]};
    adcgs_stereo_list list = {0, 0, NULL};
    if (adcgs_hull_find(&list, views, moves, n, &like, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    return list;
}

static double from_centre(const adcgs_stereo_point *p)
{
    return sqrt(pow(p->x[0] - centre[0], 2) + pow(p->x[1] - centre[1], 2) + pow(p->x[2] - centre[2], 2));
}

/** The hull of a ball contains it. From four sides it is a rounded box, whose edges stand out by less than half. */
static void a_ball_has_its_surface(void **state)
{
    put_ball();
    adcgs_stereo_list list = find(VIEWS);
    int octants = 0;
    assert_true(list.n > 500);
    for (size_t i = 0; i < list.n; i++) {
        const adcgs_stereo_point *p = &list.point[i];
        assert_true(from_centre(p) > 0.93 * RADIUS && from_centre(p) < 1.5 * RADIUS);
        assert_true(p->t == like.t && p->moves && p->size > 0 && (double)p->size < 2 * (AWAY + 1) / FOCAL);
        octants |= 1 << ((p->x[0] > centre[0]) + 2 * (p->x[1] > centre[1]) + 4 * (p->x[2] > centre[2]));
    }
    assert_int_equal(octants, 255);
    adcgs_stereo_list_clear(&list);
}

/** A point has the colour of a view on its side, except for a few at the box's edges, along which views look. */
static void points_look_as_who_sees_them(void **state)
{
    size_t astray = 0;
    put_ball();
    adcgs_stereo_list list = find(VIEWS);
    for (size_t i = 0; i < list.n; i++) {
        const adcgs_stereo_point *p = &list.point[i];
        const int view = (int)(p->rgb[0] / 0.2f + 0.5f) - 1;
        assert_in_range(view, 0, VIEWS - 1);
        const double *c = views[view].centre;
        const double side = (p->x[0] - centre[0]) * c[0] + (p->x[1] - centre[1]) * c[1];
        astray += side < -0.3 * RADIUS * AWAY;
    }
    print_message("%zu of %zu points have the colour of a view from behind\n", astray, list.n);
    assert_true(astray < list.n / 20);
    adcgs_stereo_list_clear(&list);
}

/** A silhouette with a hole of a few pixels is whole. */
static void holes_are_closed(void **state)
{
    put_ball();
    adcgs_stereo_list whole = find(VIEWS);
    double at[2] = {0, 0}, depth;
    assert_true(adcgs_stereo_rig_project(&views[0], centre, at, &depth));
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            mask[0][((int)at[1] + y) * WIDTH + (int)at[0] + x] = 0;
    adcgs_stereo_list closed = find(VIEWS);
    assert_int_equal(closed.n, whole.n);
    adcgs_stereo_list_clear(&whole);
    adcgs_stereo_list_clear(&closed);
}

/** A view that sees no motion removes everything. If everything moves, there is no evidence, and the search ends soon. */
static void test_no_hull_without_evidence(void **state)
{
    put_ball();
    memset(mask[1], 0, sizeof mask[1]);
    adcgs_stereo_list list = find(VIEWS);
    assert_int_equal(list.n, 0);
    memset(mask, 1, sizeof mask);
    list = find(VIEWS);
    for (size_t i = 0; i < list.n; i++)
        assert_true(isfinite(list.point[i].x[0]));
    adcgs_stereo_list_clear(&list);
    put_ball();
    list = find(1);
    assert_int_equal(list.n, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_has_its_surface),
        cmocka_unit_test(points_look_as_who_sees_them),
        cmocka_unit_test(holes_are_closed),
        cmocka_unit_test(test_no_hull_without_evidence),
    };
    return cmocka_run_group_tests(tests, put_views, NULL);
}
