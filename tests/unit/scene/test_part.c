/* SPDX-License-Identifier: BSD-2-Clause */
/** \file A scene cut in time: the cuts, and the views of its parts. */
#include "scene/part.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

static adcgs_error error;

enum { CAMERAS = 2, MOMENTS = 11, VIEWS = CAMERAS * MOMENTS };

static adcgs_scene_view views[VIEWS], tests[1];
static adcgs_scene scene = {.directory = "here",
                            .views = {[ADCGS_SPLIT_TRAIN] = views, [ADCGS_SPLIT_TEST] = tests},
                            .n_views = {[ADCGS_SPLIT_TRAIN] = VIEWS, [ADCGS_SPLIT_TEST] = 1},
                            .duration = 1,
                            .n_times = MOMENTS,
                            .rate = {10, 1}};

/** A tenth of a second from one frame to the next, in mixed order. */
static int set_up(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i++) {
        views[i].time = (double)(i * 7 % MOMENTS) / (MOMENTS - 1);
        views[i].frame = i;
    }
    return 0;
}

/** Expects these crossfades of the first and the second last part; the last part has none. */
static void expect_reach(double seconds, double fade, double first, double late)
{
    adcgs_cuts cuts = {.n = 0};
    assert_int_equal(adcgs_cuts_find(&cuts, &scene, seconds, fade, &error), ADCGS_OK);
    assert_float_equal(cuts.reach[0], first, 1e-12);
    assert_float_equal(cuts.reach[cuts.n - 2], late, 1e-12);
    assert_true(cuts.reach[cuts.n - 1] == 0);
    adcgs_cuts_clear(&cuts);
}

static void parts_reach_to_moments(void **state)
{
    (void)state;
    expect_reach(0.5, 0, 0, 0);
    expect_reach(0.5, 0.09, 0, 0);
    expect_reach(0.5, 0.1, 0.1, 0.1);
    expect_reach(0.5, 1e6, 0.1, 0.1); /* a quarter is 0.125 */
    expect_reach(0.4, 0.1, 0.1, 0);   /* a quarter of 0.4, and of 0.2 */
    expect_reach(0.1, 0.1, 0, 0);
}

static void expect_cuts(double seconds, const double *at, uint32_t n, uint32_t moments)
{
    adcgs_cuts cuts = {.n = 0};
    assert_int_equal(adcgs_cuts_find(&cuts, &scene, seconds, 0, &error), ADCGS_OK);
    assert_int_equal(cuts.n, n);
    assert_int_equal(cuts.moments, moments);
    for (uint32_t i = 0; i <= n; i++)
        assert_float_equal(cuts.at[i], at[i], 1e-12);
    adcgs_cuts_clear(&cuts);
}

static void cuts_lie_at_moments(void **state)
{
    (void)state;
    expect_cuts(0.5, (const double[]){0, 0.5, 1}, 2, 6);
    expect_cuts(0.33, (const double[]){0, 0.3, 0.7, 1}, 3, 4);
    expect_cuts(0.4, (const double[]){0, 0.4, 0.8, 1}, 3, 3); /* the rest is half of a part */
    expect_cuts(0.47, (const double[]){0, 0.5, 1}, 2, 6);     /* here less */
    expect_cuts(0.1, (const double[]){0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1}, 10, 2);
    expect_cuts(1e-9, (const double[]){0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1}, 10, 2);
    expect_cuts(1, (const double[]){0, 1}, 1, MOMENTS);
    expect_cuts(1e6, (const double[]){0, 1}, 1, MOMENTS);
}

/**
 * Each view is in one part, or in both where one crossfades into the other, with times from the part's start. No other views are.
 */
static void parts_share_what_is_at_cuts(void **state)
{
    (void)state;
    adcgs_cuts cuts = {.n = 0};
    int seen[VIEWS] = {0};
    assert_int_equal(adcgs_cuts_find(&cuts, &scene, 0.42, 0.1, &error), ADCGS_OK);
    for (uint32_t i = 0; i < cuts.n; i++) {
        adcgs_scene part;
        assert_int_equal(adcgs_scene_part(&part, &scene, &cuts, i, &error), ADCGS_OK);
        assert_ptr_equal(part.whole, &scene);
        assert_float_equal(part.duration, cuts.at[i + 1] + cuts.reach[i] - cuts.at[i], 1e-12);
        assert_int_equal(part.n_views[ADCGS_SPLIT_TRAIN], CAMERAS * part.n_times);
        assert_int_equal(part.n_views[ADCGS_SPLIT_TEST], 0);
        for (uint32_t v = 0; v < part.n_views[ADCGS_SPLIT_TRAIN]; v++) {
            const adcgs_scene_view *view = &part.views[ADCGS_SPLIT_TRAIN][v];
            assert_true(view->time >= 0 && view->time <= part.duration);
            assert_float_equal(view->time + cuts.at[i], views[view->frame].time, 1e-12);
            seen[view->frame]++;
        }
        adcgs_scene_part_clear(&part);
    }
    for (int i = 0; i < VIEWS; i++)
        assert_int_equal(seen[i], i * 7 % MOMENTS == 4 || i * 7 % MOMENTS == 5 ? 2 : 1);
    adcgs_cuts_clear(&cuts);
}

static void one_moment_is_not_cut(void **state)
{
    (void)state;
    adcgs_scene still = scene;
    adcgs_cuts cuts = {.n = 0};
    still.n_views[ADCGS_SPLIT_TRAIN] = 1;
    assert_int_equal(adcgs_cuts_find(&cuts, &still, 0.5, 0.1, &error), ADCGS_ERR_DATA);
    assert_non_null(strstr(error.text, "only one distinct time"));
    adcgs_cuts_clear(&cuts);
}

int main(void)
{
    const struct CMUnitTest list[] = {
        cmocka_unit_test(cuts_lie_at_moments),
        cmocka_unit_test(parts_share_what_is_at_cuts),
        cmocka_unit_test(parts_reach_to_moments),
        cmocka_unit_test(one_moment_is_not_cut),
    };
    return cmocka_run_group_tests(list, set_up, NULL);
}
