/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Resolved configurations: scene, matching, trials and targets decide open settings, and are recorded. */
#include "train/resolve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static adcgs_error error;

static adcgs_train_config request(const char *settings)
{
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, "fast", &error), ADCGS_OK);
    if (adcgs_train_set(&c, settings, &error) != ADCGS_OK)
        fail_msg("%s: %s", settings, error.text);
    return c;
}

/** The record of a setting; NULL if its requested value is used. */
static const adcgs_resolution *find(const adcgs_train_config *c, const char *name)
{
    static adcgs_resolution found;
    size_t row = 0;
    while (adcgs_resolve_next(c, &row, &found))
        if (!strcmp(found.setting->name, name))
            return &found;
    return NULL;
}

static void expect_record(const adcgs_train_config *c, const char *name, double requested, double used, const char *by)
{
    const adcgs_resolution *const r = find(c, name);
    assert_non_null(r);
    assert_true(r->requested == requested && r->used == used);
    assert_true(adcgs_setting_get(r->setting, c) == used);
    assert_string_equal(r->by, by);
    assert_true(r->reason[0] != '\0');
}

static size_t count_records(const adcgs_train_config *c)
{
    adcgs_resolution r;
    size_t row = 0, n = 0;
    while (adcgs_resolve_next(c, &row, &r))
        n++;
    return n;
}

/** A scene of several cameras changes the loss and the time table. A request has no records. */
static void scenes_decide_what_is_open(void **state)
{
    const adcgs_scene_facts several = {.times = 10, .is_shared = 1, .is_sparse = 0};
    const adcgs_scene_facts alone = {.times = 100, .is_shared = 0, .is_sparse = 1};
    const adcgs_scene_facts still = {.times = 1, .is_shared = 1, .is_sparse = 1};
    adcgs_train_config c = request("");
    assert_int_equal(count_records(&c), 0);
    adcgs_resolve_scene(&c, &several);
    expect_record(&c, "time_rows", 40, 10, "scene");
    expect_record(&c, "smooth_time", 1, 0, "scene");
    expect_record(&c, "rigidity_weight", (double)0.02f, 0, "scene");
    expect_record(&c, "scale_reg_start", (double)0.3f, 0, "scene");
    assert_int_equal(count_records(&c), 4);
    c = request("");
    adcgs_resolve_scene(&c, &alone);
    expect_record(&c, "l2_share", (double)0.9f, 0.5, "scene");
    assert_int_equal(count_records(&c), 1);
    c = request("");
    adcgs_resolve_scene(&c, &still);
    assert_true(!c.params.time_rows && !c.params.time_width && !c.params.spans && !c.params.bodies && !c.params.smooth_time);
    assert_true(c.rigidity_weight == 0 && c.scale_reg_start > 0);
}

/** A value that the user gave stays, unless the scene cannot have it. */
static void given_values_stay(void **state)
{
    const adcgs_scene_facts several = {.times = 10, .is_shared = 1, .is_sparse = 0};
    adcgs_train_config c =
        request("smooth_time=1,rigidity_weight=0.5,scale_reg_start=0.1,scale=1,max_anchors=77,start_anchors=7,lambda=2");
    adcgs_resolve_scene(&c, &several);
    adcgs_resolve_size(&c, 3);
    assert_false(adcgs_resolve_wants_details(&c));
    adcgs_resolve_anchors(&c, 1000000);
    adcgs_resolve_start(&c, 0);
    assert_true(adcgs_resolve_contrast(&c, 0.5) == 2);
    assert_true(c.params.smooth_time == 1 && c.rigidity_weight == 0.5f && c.scale_reg_start == 0.1f && c.scale == 1);
    assert_true(c.max_anchors == 77 && c.start_anchors == 7);
    expect_record(&c, "time_rows", 40, 10, "scene");
    assert_int_equal(count_records(&c), 1);
}

/** Details, points and contrast set the values that the user left open. */
static void anchors_follow_details(void **state)
{
    adcgs_train_config c = request("");
    assert_true(adcgs_resolve_wants_details(&c));
    adcgs_resolve_anchors(&c, 400);
    expect_record(&c, "max_anchors", 6000, 1000, "scene");
    assert_null(find(&c, "start_anchors"));
    adcgs_resolve_anchors(&c, 1);
    expect_record(&c, "max_anchors", 6000, 100, "scene"); /* the minimum; the request is still known */
    expect_record(&c, "start_anchors", 1000, 100, "scene");
    c = request("");
    adcgs_resolve_start(&c, 0);
    expect_record(&c, "start_anchors", 1000, 4500, "scene");
    assert_true(adcgs_resolve_contrast(&c, 0.5) == 0.5 * (double)0.1f && c.lambda == 0.1f); /* the trainer has its own lambda */
    assert_non_null(find(&c, "lambda"));
    c = request("");
    adcgs_resolve_size(&c, 2);
    expect_record(&c, "scale", 1, 2, "scene");
    assert_true(adcgs_setting_is_given(&c, "scale") == 0);
}

static void verdicts_and_matching_are_recorded(void **state)
{
    uint8_t dropped[ADCGS_MECHANISMS] = {[ADCGS_GAINS] = 1, [ADCGS_SQUARES] = 1};
    adcgs_train_config c = request("gains=1");
    adcgs_resolve_trials(&c, dropped);
    expect_record(&c, "gains", 1, 0, "trial");
    expect_record(&c, "l2_share", (double)0.9f, 0, "trial");
    adcgs_resolve_matching(&c, 1, -1);
    assert_int_equal(count_records(&c), 2);
    adcgs_resolve_matching(&c, 0, 2);
    expect_record(&c, "lifetimes", 1, 0, "matching");
    expect_record(&c, "bodies", 8, 2, "matching");
    adcgs_params previous = c.params;
    previous.time_rows = 9;
    adcgs_resolve_previous(&c, &previous);
    expect_record(&c, "time_rows", 40, 9, "segments");
    assert_int_equal(count_records(&c), 5);
}

/** A trial replaces given values, too. Its request keeps its own, and its record starts from the record of the whole run. */
static void trials_are_recorded(void **state)
{
    adcgs_trial_facts facts = {.without = ADCGS_GAINS, .iterations = 410, .seed = 8, .reduction = 30};
    adcgs_train_config c = request("iterations=5000,gains=1,seed=7,batch=2");
    adcgs_resolve_size(&c, 3);
    c.target = ADCGS_TARGET_PSNR;
    c.target_value = 30;
    c.time_limit = 9;
    const adcgs_train_config before = c;
    adcgs_resolve_trial(&c, &facts);
    assert_true(c.target == ADCGS_TARGET_NONE && c.time_limit == 0);
    expect_record(&c, "iterations", 5000, 410, "trial");
    expect_record(&c, "densify_interval", 100, 20, "trial");
    expect_record(&c, "batch", 2, 1, "trial");
    expect_record(&c, "tiers", 4, 1, "trial");
    expect_record(&c, "seed", 7, 8, "trial");
    expect_record(&c, "scale", 1, 64, "trial"); /* at most the maximum of the setting */
    expect_record(&c, "half_size_until", (double)0.7f, 2, "trial");
    expect_record(&c, "gains", 1, 0, "trial");
    assert_int_equal(count_records(&c), 8);
    assert_int_equal(adcgs_train_check(&c, &error), ADCGS_OK);
    c = before;
    facts = (adcgs_trial_facts){.without = ADCGS_MECHANISM_NONE, .iterations = 15, .seed = 7, .reduction = 0};
    adcgs_resolve_trial(&c, &facts);
    assert_true(c.densify_interval == 1 && c.gains == 1 && c.half_size_until == 0.7f);
    expect_record(&c, "scale", 1, 3, "scene");
    assert_null(find(&c, "seed"));
}

static void targets_are_recorded(void **state)
{
    adcgs_train_config c = request("theta_width=31");
    c.target = ADCGS_TARGET_SIZE;
    c.target_value = 30000;
    assert_int_equal(adcgs_resolve_target(&c, &error), ADCGS_OK);
    assert_true(c.shape.theta_width == 31 && c.max_anchors < 6000);
    expect_record(&c, "max_anchors", 6000, c.max_anchors, "target");
    c = request("");
    assert_int_equal(adcgs_resolve_target(&c, &error), ADCGS_OK);
    assert_int_equal(count_records(&c), 0);
}

/** A value that returns to the request leaves no record. */
static void effort_comes_and_goes(void **state)
{
    adcgs_train_config c = request("iterations=5000");
    adcgs_resolve_effort(&c, 200, 3);
    expect_record(&c, "iterations", 5000, 200, "effort");
    assert_true(c.time_limit == 3);
    adcgs_resolve_effort(&c, 5000, 0);
    assert_null(find(&c, "iterations"));
    assert_true(c.time_limit == 0 && c.iterations == 5000);
    adcgs_resolve_delay(&c, 8);
    expect_record(&c, "matching_frames", 48, 8, "effort");
    adcgs_resolve_parts(&c, 5);
    expect_record(&c, "time_rows", 40, 5, "segments");
    adcgs_resolve_whole(&c, 3);
    expect_record(&c, "iterations", 5000, 15000, "segments");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_decide_what_is_open), cmocka_unit_test(given_values_stay),
        cmocka_unit_test(anchors_follow_details),     cmocka_unit_test(verdicts_and_matching_are_recorded),
        cmocka_unit_test(trials_are_recorded),        cmocka_unit_test(targets_are_recorded),
        cmocka_unit_test(effort_comes_and_goes),
    };
    return cmocka_run_group_tests_name("resolve", tests, NULL, NULL);
}
