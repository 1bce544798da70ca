/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The point under a place of the image: the centre of an orbit. */
#include "config.h"

#include "decoder_fixture.h"

#include "camera/pivot.h"
#include "geometry/rotation.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/** The pivot lies on the ray of its place, between the depths of a full image around it. */
static void test_pivot(void **state)
{
    enum { SIZE = FIXTURE_WIDTH * FIXTURE_HEIGHT };
    static float depth[SIZE], alpha[SIZE], around[SIZE];
    const fixture *f = *state;
    const adcgs_camera *const c = &fixture_camera;
    adcgs_decoder *d = open_with(f, NULL);
    double point[3], at[2];
    adcgs_error why;
    size_t n = 0;
    assert_int_equal(adcgs_render_depth(d, c, 0.0, depth, alpha, NULL), ADCGS_OK);
    for (int y = 0; y < FIXTURE_HEIGHT; y++)
        for (int x = 0; x < FIXTURE_WIDTH; x++)
            if (abs(x - FIXTURE_WIDTH / 2) <= FIXTURE_WIDTH / 8 && abs(y - FIXTURE_HEIGHT / 2) <= FIXTURE_WIDTH / 8 &&
                alpha[y * FIXTURE_WIDTH + x] >= 0.5f)
                around[n++] = depth[y * FIXTURE_WIDTH + x];
    assert_true(n > 5);
    qsort(around, n, sizeof *around, compare);
    assert_int_equal(adcgs_pivot_find(point, d, c, 0.0, 0.5, 0.5, &why), ADCGS_OK);
    assert_true(adcgs_camera_sees(c, point, 0.0, at));
    assert_true(fabs(at[0] - 0.5 * FIXTURE_WIDTH) < 1e-6 && fabs(at[1] - 0.5 * FIXTURE_HEIGHT) < 1e-6);
    double away = 0;
    for (int i = 0; i < 3; i++)
        away += (point[i] - c->cam_to_world[4 * i + 3]) * c->cam_to_world[4 * i + 2];
    assert_true(away >= 0.999 * (double)around[0] && away <= 1.001 * (double)around[n - 1]);
    adcgs_camera up = *c; /* far away, and turned around: it shows background alone */
    for (int i = 0; i < 3; i++) {
        up.cam_to_world[4 * i + 3] -= 100 * up.cam_to_world[4 * i + 2];
        up.cam_to_world[4 * i] = -up.cam_to_world[4 * i];
        up.cam_to_world[4 * i + 2] = -up.cam_to_world[4 * i + 2];
    }
    assert_int_equal(adcgs_pivot_find(point, d, &up, 0.0, 0.05, 0.05, &why), ADCGS_ERR_DATA);
    up.fx = -1;
    assert_true(adcgs_pivot_find(point, d, &up, 0.0, 0.5, 0.5, &why) != ADCGS_OK);
    adcgs_close(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_pivot, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
