/* SPDX-License-Identifier: BSD-2-Clause */
/** \file SpacetimeGaussians' PLY. */
#include "dynamic_fixture.h"

static void test_lite(void **state)
{
    const adcgs_dynamic_options clip = {.frames = 24, .rate = {24, 1}};
    const tolerance most = {1e-5, 1e-5, 1e-5, 1e-5, 1e-5};
    adcgs_dynamic *d = open_sample(SAMPLES "stg_lite/point_cloud.ply", &clip);
    assert_int_equal(d->n, 2000);
    assert_int_equal(d->frames, 24);
    assert_true(d->has_identity && d->is_continuous);
    expect_answers(d, "stg_lite", 1.0, &most);
    adcgs_dynamic_free(&d);
}

/** The time of a clip stretches with its options, its states do not change. */
static void test_clock(void **state)
{
    const adcgs_dynamic_options slow = {.frames = 48, .rate = {12, 1}};
    const tolerance most = {1e-5, 1e-5, 1e-5, 1e-5, 1e-5};
    adcgs_dynamic *d = open_sample(SAMPLES "stg_lite/point_cloud.ply", &slow);
    expect_answers(d, "stg_lite", 4.0, &most);
    adcgs_dynamic_free(&d);
    d = open_sample(SAMPLES "stg_lite/point_cloud.ply", NULL);
    assert_true(d->frames == ADCGS_DYNAMIC_FRAMES && adcgs_fps_value(d->rate) == ADCGS_DYNAMIC_RATE);
    adcgs_dynamic_free(&d);
}

static void test_full(void **state)
{
    const adcgs_dynamic_options partial = {.partial = 1};
    const char *const path = real_data(SAMPLES "stg_full/point_cloud.ply");
    adcgs_dynamic *d;
    expect_error(adcgs_dynamic_open(&d, path, NULL, &error), ADCGS_ERR_UNSUPPORTED, "full model", "network");
    assert_null(d);
    d = open_sample(SAMPLES "stg_full/point_cloud.ply", &partial);
    assert_true(d->n == 200 && strstr(d->remark, "approximate"));
    adcgs_dynamic_free(&d);
}

static void test_damage(void **state)
{
    survive_damage(SAMPLES "stg_lite/point_cloud.ply");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lite),
        cmocka_unit_test(test_clock),
        cmocka_unit_test(test_full),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
