/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Trials judge on training views that they hold back, drop the mechanisms that lose, and keep the others. */
#include "tiny_scene.h"

#include "train/resolve.h"
#include "train/trial/trial.h"
#include "train/trial/trial_scene.h"

/* ---- Held-back views ---- */

enum { MANY = 1200 };

static adcgs_scene_view many[MANY];

/** A scene of n views by several cameras in turn; each turn is a second later. */
static adcgs_scene scene_of(uint32_t n, uint32_t cameras)
{
    for (uint32_t i = 0; i < n; i++) {
        many[i] = (adcgs_scene_view){.time = i / cameras};
        many[i].camera = (adcgs_camera){.width = 64,
                                        .height = 64,
                                        .fx = 60,
                                        .fy = 60,
                                        .cx = 32,
                                        .cy = 32,
                                        .near_plane = 0.1,
                                        .cam_to_world = {1, 0, 0, i % cameras, 0, 1, 0, 0, 0, 0, 1, 0}};
    }
    return (adcgs_scene){.views = {many}, .n_views = {n}, .duration = (n - 1) / cameras, .n_times = (n + cameras - 1) / cameras};
}

/** Each view is trained on, or judges, or neither if too many would judge; none does both. */
static void check_split(const adcgs_scene *s, uint32_t n, uint32_t trained, uint32_t judges)
{
    assert_int_equal(s->n_views[ADCGS_SPLIT_TRAIN], trained);
    assert_int_equal(s->n_views[ADCGS_SPLIT_VAL], judges);
    assert_int_equal(s->n_views[ADCGS_SPLIT_TEST], 0);
    for (uint32_t i = 0; i < judges; i++)
        for (uint32_t k = 0; k < trained; k++) {
            const adcgs_scene_view *a = &s->views[ADCGS_SPLIT_VAL][i], *b = &s->views[ADCGS_SPLIT_TRAIN][k];
            assert_false(a->time == b->time && a->camera.cam_to_world[3] == b->camera.cam_to_world[3]);
        }
    assert_true(trained + judges <= n);
}

static void views_are_held_back(void **state)
{
    adcgs_trial_scene t = {.scene = {.n_times = 0}};
    adcgs_scene s = scene_of(40, 40); /* one image per camera: one in eight */
    assert_int_equal(adcgs_trial_scene_make(&t, &s, &error), ADCGS_OK);
    check_split(&t.scene, 40, 35, 5);
    adcgs_trial_scene_clear(&t);
    s = scene_of(80, 8); /* whole cameras: one of eight, with all of its views */
    assert_int_equal(adcgs_trial_scene_make(&t, &s, &error), ADCGS_OK);
    check_split(&t.scene, 80, 70, 10);
    const adcgs_scene_view *const held = t.scene.views[ADCGS_SPLIT_VAL];
    for (uint32_t i = 1; i < 10; i++)
        assert_true(held[i].camera.cam_to_world[3] == held[0].camera.cam_to_world[3]);
    adcgs_trial_scene_clear(&t);
    s = scene_of(80, 1); /* a video of one static camera: single images */
    assert_int_equal(adcgs_trial_scene_make(&t, &s, &error), ADCGS_OK);
    check_split(&t.scene, 80, 70, 10);
    assert_int_equal(t.scene.n_times, 70);
    adcgs_trial_scene_clear(&t);
    s = scene_of(11, 11); /* too few */
    assert_int_equal(adcgs_trial_scene_make(&t, &s, &error), ADCGS_OK);
    assert_int_equal(t.scene.n_views[ADCGS_SPLIT_VAL], 0);
    adcgs_trial_scene_clear(&t);
}

/** A long scene gives an interval about its middle, whose time begins at 0; a large static one is thinned. */
static void long_scenes_give_a_stretch(void **state)
{
    adcgs_trial_scene t = {.scene = {.n_times = 0}};
    adcgs_scene s = scene_of(MANY, 6);
    assert_int_equal(adcgs_trial_scene_make(&t, &s, &error), ADCGS_OK);
    assert_true(t.scene.n_views[ADCGS_SPLIT_TRAIN] > ADCGS_TRIAL_VIEWS / 2);
    assert_true(t.scene.n_views[ADCGS_SPLIT_TRAIN] <= ADCGS_TRIAL_VIEWS);
    assert_int_equal(t.scene.n_views[ADCGS_SPLIT_VAL], ADCGS_TRIAL_JUDGES);
    assert_true(t.scene.duration > 0.3 * s.duration && t.scene.duration < 0.5 * s.duration);
    for (uint32_t i = 0; i < t.scene.n_views[ADCGS_SPLIT_TRAIN]; i++) {
        const double time = t.scene.views[ADCGS_SPLIT_TRAIN][i].time;
        assert_true(time >= 0 && time <= t.scene.duration);
    }
    adcgs_trial_scene_clear(&t);
    s = scene_of(MANY, MANY);
    s.n_times = 1;
    s.duration = 0;
    assert_int_equal(adcgs_trial_scene_make(&t, &s, &error), ADCGS_OK);
    assert_true(t.scene.n_views[ADCGS_SPLIT_TRAIN] > 300 && t.scene.n_views[ADCGS_SPLIT_TRAIN] <= ADCGS_TRIAL_VIEWS);
    assert_int_equal(t.scene.n_views[ADCGS_SPLIT_VAL], ADCGS_TRIAL_JUDGES);
    adcgs_trial_scene_clear(&t);
}

/* ---- Verdicts ---- */

static int stop_at_third(void *user, const char *without, uint32_t done, uint32_t most)
{
    uint32_t *calls = user;
    assert_int_equal(done, *calls);
    assert_true(done < most && (!without) == (done == 0));
    return ++*calls == 3;
}

static const adcgs_trial *find(const adcgs_trials *t, const char *name)
{
    for (uint32_t i = 0; i < t->n; i++)
        if (!strcmp(adcgs_mechanism_names[t->of[i].mechanism], name))
            return &t->of[i];
    return NULL;
}

/** A scale regulariser that is far too strong is detected and dropped, and no other mechanism is; with any number of threads. */
static void losing_mechanisms_are_dropped(void **state)
{
    adcgs_train_config config = small_config();
    char texts[2][ADCGS_TRIALS_TEXT];
    adcgs_pool *alone;
    adcgs_trials trials;
    config.trial_share = 1;
    config.iterations = 100;
    config.scale_reg_weight = 100;
    assert_int_equal(adcgs_pool_create(&alone, 1, &error), ADCGS_OK);
    for (int i = 0; i < 2; i++) {
        adcgs_train_config c = config;
        uint8_t dropped[ADCGS_MECHANISMS];
        const adcgs_trials_options options = {.cpu = adcgs_cpu_best(), .pool = i ? alone : pool};
        if (adcgs_trials_run(&trials, &c, scene, &options, &error) != ADCGS_OK)
            fail_msg("%s", error.text);
        adcgs_trials_format(&trials, texts[i]);
        adcgs_trials_dropped(&trials, dropped);
        adcgs_resolve_trials(&c, dropped);
        const adcgs_trial *const price = find(&trials, "scale_price"), *const squares = find(&trials, "squares");
        assert_non_null(price);
        assert_non_null(squares);
        assert_true(price->dropped && price->without > price->with + 0.3);
        assert_false(squares->dropped);
        assert_true(c.scale_reg_weight == 0 && c.l2_share == config.l2_share);
        assert_null(find(&trials, "matching")); /* it is off */
        assert_null(find(&trials, "bodies"));   /* there are none */
    }
    assert_string_equal(texts[0], texts[1]);
    assert_non_null(strstr(texts[0], " scale_price="));
    adcgs_pool_free(&alone);
}

/** A trial that diverges counts 0 dB, and is no failure of the run; where all diverge, nothing is dropped. */
static void diverging_trials_count_nothing(void **state)
{
    const adcgs_trials_options options = {.cpu = adcgs_cpu_best(), .pool = pool};
    adcgs_train_config config = small_config();
    adcgs_trials trials;
    config.trial_share = 1;
    config.iterations = 100;
    adcgs_scene spoilt = *scene;
    spoilt.background[1] = NAN;
    assert_int_equal(adcgs_trials_run(&trials, &config, &spoilt, &options, &error), ADCGS_OK);
    assert_true(trials.n > 0);
    for (uint32_t i = 0; i < trials.n; i++)
        assert_true(trials.of[i].with == 0 && trials.of[i].without == 0 && !trials.of[i].dropped);
}

static void trials_can_be_stopped(void **state)
{
    adcgs_train_config config = small_config();
    uint32_t calls = 0;
    const adcgs_trials_options options = {.cpu = adcgs_cpu_best(), .pool = pool, .progress = stop_at_third, .user = &calls};
    adcgs_trials trials;
    config.trial_share = 1;
    config.iterations = 100;
    assert_int_equal(adcgs_trials_run(&trials, &config, scene, &options, &error), ADCGS_ERR_IO);
    assert_int_equal(calls, 3);
}

/** Short runs, runs with a time limit and runs that disable trials have none, and print nothing about them. */
static void short_runs_have_no_trials(void **state)
{
    adcgs_train_config config = small_config();
    const adcgs_trials_options options = {.cpu = adcgs_cpu_best(), .pool = pool};
    char text[ADCGS_TRIALS_TEXT];
    adcgs_trials trials;
    assert_true(config.trial_share * (float)config.iterations < 100);
    assert_int_equal(adcgs_trials_run(&trials, &config, scene, &options, &error), ADCGS_OK);
    assert_int_equal(trials.n, 0);
    adcgs_trials_format(&trials, text);
    assert_string_equal(text, "");
    config.iterations = 20000;
    assert_int_equal(adcgs_trial_length(&config), 400);
    config.time_limit = 600;
    assert_int_equal(adcgs_trial_length(&config), 0);
    config.time_limit = 0;
    config.trial_share = 0;
    assert_int_equal(adcgs_trial_length(&config), 0);
}

/* ---- Resumed runs ---- */

/** A resumed run adopts the mechanisms that trials turned off, nothing else, and keeps their figures. */
static void resumed_runs_adopt_verdicts(void **state)
{
    static const char said[] = "views=3 iterations=100 gains=20.10/20.00 scale_price=20.00/21.00 dropped=squares,scale_price";
    adcgs_train_config config = small_config(), other = config;
    config.scale_reg_weight = config.l2_share = 0;
    adcgs_trainer *t = make_trainer(&config, pool);
    const uint32_t until = 10;
    uint8_t dropped[ADCGS_MECHANISMS];
    int stopped;
    memcpy(t->trials, said, sizeof said);
    assert_int_equal(adcgs_trainer_run(t, stop_at, (void *)(uintptr_t)&until, &stopped, &error), ADCGS_OK);
    assert_int_equal(adcgs_trainer_save(t, in("state"), &error), ADCGS_OK);
    adcgs_trainer_free(&t);
    other.lambda = 0.5f;
    assert_true(other.scale_reg_weight > 0);
    assert_int_equal(adcgs_checkpoint_dropped(dropped, in("state"), &error), ADCGS_OK);
    adcgs_resolve_trials(&other, dropped);
    assert_true(other.scale_reg_weight == 0 && other.l2_share == 0 && other.lambda == 0.5f && other.gains == 1);
    t = make_trainer(&other, pool);
    if (adcgs_trainer_load(t, in("state"), &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_string_equal(t->trials, said);
    adcgs_trainer_free(&t);
    assert_int_not_equal(adcgs_checkpoint_dropped(dropped, in("nothing"), &error), ADCGS_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_held_back),
        cmocka_unit_test(long_scenes_give_a_stretch),
        cmocka_unit_test(losing_mechanisms_are_dropped),
        cmocka_unit_test(trials_can_be_stopped),
        cmocka_unit_test(diverging_trials_count_nothing),
        cmocka_unit_test(short_runs_have_no_trials),
        cmocka_unit_test(resumed_runs_adopt_verdicts),
    };
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
