/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Motion that lifetimes need: points that leave static surfaces, and in films fast ones that can be predicted. */
#include "config.h"

#include "init/motion_check.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { FRAMES = 12, EACH = 80, POINTS = FRAMES * EACH };

typedef struct scene {
    adcgs_stereo found;
    adcgs_stereo_point points[POINTS];
    float times[FRAMES];
} scene;

static double random_unit(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/** A cloud of points that moves along x by `way` per clip; its stated velocities are off by `noise` in each frame. */
static void make(scene *s, double way, double noise, int monocular)
{
    uint32_t state = 7;
    memset(s, 0, sizeof *s);
    s->found = (adcgs_stereo){.n_moving = POINTS,
                              .moving = s->points,
                              .n_frames = FRAMES,
                              .frame_time = s->times,
                              .monocular = monocular};
    for (int f = 0; f < FRAMES; f++) {
        const double off[2] = {noise * random_unit(&state), noise * random_unit(&state)};
        s->times[f] = (float)f / (FRAMES - 1);
        for (int i = 0; i < EACH; i++) {
            adcgs_stereo_point *const p = &s->points[f * EACH + i];
            p->t = s->times[f];
            p->velocity[0] = (float)(way + off[0]);
            p->velocity[1] = (float)off[1];
            for (int a = 0; a < 3; a++)
                p->x[a] = 0.2 * random_unit(&state) + (a == 0 ? way * (double)p->t : 0);
        }
    }
}

static int moves(const scene *s)
{
    int result = -1;
    assert_int_equal(adcgs_stereo_check_motion(&result, &s->found, NULL), ADCGS_OK);
    return result;
}

static void test_static_surfaces(void **state)
{
    scene *const s = malloc(sizeof *s);
    assert_non_null(s);
    make(s, 1.0, 0.0, 0);
    assert_true(moves(s));
    for (int i = 0; i < POINTS; i++)
        s->points[i].in_place = 1;
    assert_false(moves(s)); /* shadows and uncovered background alone */
    for (int i = 0; i < POINTS / 10; i++)
        s->points[i].body = 1;
    assert_true(moves(s)); /* a body that turns in its place */
    s->found.n_moving = 0;
    assert_false(moves(s));
    free(s);
}

static void test_films(void **state)
{
    scene *const s = malloc(sizeof *s);
    assert_non_null(s);
    make(s, 1.0, 0.0, 1);
    assert_true(moves(s));
    make(s, 1.0, 0.3, 1);
    assert_true(moves(s));
    make(s, 0.2, 0.0, 1);
    assert_false(moves(s)); /* slow */
    make(s, 1.0, 16.0, 1);
    assert_false(moves(s)); /* velocities that predict nothing */
    s->found.monocular = 0;
    assert_true(moves(s)); /* several cameras measure positions in each frame */
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_static_surfaces), cmocka_unit_test(test_films)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
