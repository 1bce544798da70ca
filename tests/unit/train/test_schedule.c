/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The schedule of a training run: the part of time that is trained on, averages, settings that depend on the scene, learning
 * rates, remaining time.
 */
#include "training_runs.h"

#include "encode/quantise.h"
#include "train/schedule.h"
#include "train/stage_table.h"

#include <math.h>

/* ---- The part of time that is trained on ---- */

static float *time_row(adcgs_trainer *t, int row)
{
    return t->f->param[ADCGS_P_TIME].p + (size_t)row * t->f->params.time_width;
}

/** Views enter from the middle of time outwards. A newly reached time row starts as a copy of its neighbour; others stay. */
static void windows_grow_outwards(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_curriculum *w = &t->curriculum;
    const size_t bytes = t->f->params.time_width * sizeof(float);
    const int rows = t->f->params.time_rows;
    assert_true(rows >= 6);
    adcgs_curriculum_grow(w, 0.1, t->f);
    const int first = w->first, last = w->last;
    assert_true(w->n > 0 && w->n < t->views.n && first > 0 && last < rows - 1);
    for (int i = 0; i < 100; i++) {
        const float at = t->views.list[adcgs_curriculum_pick(w, 1, (uint32_t)i)].t * (float)(rows - 1);
        assert_true(at >= (float)first && at <= (float)last);
    }
    for (int r = 0; r < rows; r++)
        time_row(t, r)[0] = (float)r;
    adcgs_curriculum_grow(w, 0.6, t->f);
    assert_true(w->first < first && w->last > last && w->last - w->first < rows - 1);
    adcgs_curriculum_grow(w, 0.2, t->f); /* takes nothing back */
    for (int r = 0; r < rows; r++)
        if (r < w->first || r > w->last)
            assert_true(time_row(t, r)[0] == (float)r);
        else
            assert_memory_equal(time_row(t, r), time_row(t, r < first ? first : r > last ? last : r), bytes);
    adcgs_curriculum_grow(w, 1, t->f);
    assert_true(w->n == t->views.n && w->first == 0 && w->last == rows - 1);
    adcgs_trainer_free(&t);
}

/* ---- The table of stages ---- */

/** Stages begin and end where their settings say, not before the stages that they need, and not if their part is left out. */
static void stages_follow_their_settings(void **state)
{
    (void)state;
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, "fast", &error), ADCGS_OK);
    for (int i = 0; i <= 1000; i++) {
        const double at = i / 1000.0;
        const int divide = at < (double)c.quarter_size_until ? 4 : at < (double)c.half_size_until ? 2 : 1;
        assert_int_equal(adcgs_coarse_divide(&c, at), divide);
        assert_int_equal(adcgs_stage_lasts(&c, ADCGS_STAGE_DENSIFY, at), at >= c.densify_start && at < c.densify_until);
        assert_int_equal(adcgs_stage_has_begun(&c, ADCGS_STAGE_PRUNE, at), at >= c.prune_at);
        assert_int_equal(adcgs_stage_has_begun(&c, ADCGS_STAGE_FREEZE, at), at >= c.freeze_start);
    }
    c.tiers_start = 0.4f;
    c.freeze_start = 0.5f;
    c.prune_units_again = 0.1f;
    assert_true(adcgs_stage_begin(&c, ADCGS_STAGE_TIERS) == (double)c.prune_at);
    assert_true(adcgs_stage_begin(&c, ADCGS_STAGE_FREEZE) == (double)c.quant_round_start);
    assert_true(adcgs_stage_begin(&c, ADCGS_STAGE_PRUNE_UNITS_AGAIN) == (double)c.prune_units_at);
    c.without_rate = 1;
    assert_false(adcgs_stage_has_begun(&c, ADCGS_STAGE_NOISE, 1) || adcgs_stage_has_begun(&c, ADCGS_STAGE_RATE, 1) ||
                 adcgs_stage_has_begun(&c, ADCGS_STAGE_MOTION_TEST, 1) || adcgs_stage_has_begun(&c, ADCGS_STAGE_PRUNE_UNITS, 1));
    assert_true(adcgs_stage_has_begun(&c, ADCGS_STAGE_STATIC_ANCHORS, 1) && adcgs_stage_has_begun(&c, ADCGS_STAGE_ROUND, 1));
    c.without_densification = 1;
    assert_false(adcgs_stage_lasts(&c, ADCGS_STAGE_DENSIFY, 0.2) || adcgs_stage_has_begun(&c, ADCGS_STAGE_PRUNE, 1) ||
                 adcgs_stage_has_begun(&c, ADCGS_STAGE_STATIC_ANCHORS, 1));
}

/** The name of a stage is displayed from the stage's begin on, and a stage that is left out has none. */
static void displayed_stages_follow_the_table(void **state)
{
    (void)state;
    static const char *const names[] = {"canonical", "deform", "noise", "rate", "round", "networks"};
    static const adcgs_stage stages[] = {ADCGS_STAGE_COARSE, ADCGS_STAGE_NOISE, ADCGS_STAGE_RATE, ADCGS_STAGE_ROUND,
                                         ADCGS_STAGE_FREEZE};
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, "fast", &error), ADCGS_OK);
    assert_string_equal(adcgs_train_stage(&c, 0), names[0]);
    for (size_t i = 0; i < ADCGS_COUNTOF(stages); i++) {
        const double begin = adcgs_stage_begin(&c, stages[i]);
        assert_string_equal(adcgs_train_stage(&c, nextafter(begin, 0)), names[i]);
        assert_string_equal(adcgs_train_stage(&c, begin), names[i + 1]);
    }
    c.without_rate = 1;
    assert_string_equal(adcgs_train_stage(&c, nextafter((double)c.quant_round_start, 0)), "deform");
    assert_string_equal(adcgs_train_stage(&c, 1), "networks");
    c.without_rounding = 1;
    assert_string_equal(adcgs_train_stage(&c, 1), "deform");
}

/** The mean of three states, exact to the bit where the states agree. A model of another size starts a mean of its own. */
static void averages_are_means(void **state)
{
    const adcgs_train_config config = all_stages_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_fmodel *f = t->f;
    adcgs_param *varied = &f->param[ADCGS_P_OMEGA], *same = &f->param[ADCGS_P_THETA];
    adcgs_weight_average average = {.n = 0};
    const float begin = varied->p[0], kept = same->p[1];
    adcgs_weight_average_take(&average, f); /* the average of no states changes nothing */
    assert_true(varied->p[0] == begin);
    for (int i = 0; i < 3; i++) {
        varied->p[0] = (const float[]){1, 2, 6}[i];
        assert_int_equal(adcgs_weight_average_add(&average, f, &error), ADCGS_OK);
    }
    adcgs_weight_average_take(&average, f);
    assert_float_equal(varied->p[0], 3, 1e-6);
    assert_true(same->p[1] == kept && average.n == 0);
    assert_int_equal(adcgs_weight_average_add(&average, f, &error), ADCGS_OK);
    adcgs_fmodel_set_width(f, ADCGS_P_THETA, 8);
    varied->p[0] = 7;
    assert_int_equal(adcgs_weight_average_add(&average, f, &error), ADCGS_OK);
    assert_int_equal(average.n, 1);
    adcgs_weight_average_take(&average, f);
    assert_true(varied->p[0] == 7);
    adcgs_weight_average_clear(&average);
    adcgs_trainer_free(&t);
}

/* ---- Brightness of cameras ---- */

/**
 * Where several views share a timestamp, defaults change: no rigidity loss, the scale regulariser from the start, and the whole
 * weight of the squared error. Settings given by the user win.
 */
static void moments_shared_by_views_change_settings(void **state)
{
    adcgs_scene alone = *scene;
    adcgs_train_config config = small_config();
    const float rigid = config.rigidity_weight, from = config.scale_reg_start, square = config.l2_share;
    const adcgs_scene *alone_and_shared[] = {&alone, scene};
    assert_true(rigid > 0 && from > 0 && square > 0.5f);
    alone.n_times = alone.n_views[ADCGS_SPLIT_TRAIN];
    for (int by_hand = 0; by_hand < 2; by_hand++)
        for (int i = 0; i < 2; i++) {
            adcgs_trainer *t;
            if (by_hand)
                assert_int_equal(adcgs_train_set(&config, "rigidity_weight=0.5,scale_reg_start=0.125,l2_share=0.75", &error),
                                 ADCGS_OK);
            assert_int_equal(adcgs_trainer_create(&t, alone_and_shared[i], &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
            assert_true(t->config.rigidity_weight == (by_hand ? 0.5f : i ? 0 : rigid));
            assert_true(t->config.scale_reg_start == (by_hand ? 0.125f : i ? 0 : from));
            assert_true(t->config.l2_share == (by_hand ? 0.75f : i ? square : 0.5f));
            adcgs_trainer_free(&t);
        }
}

/** Time follows a spline where fewer than half of the cameras see each frame, except if the user set it otherwise. */
static void few_cameras_make_time_smooth(void **state)
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    adcgs_scene alone = *scene, few = *scene;
    const adcgs_scene *scenes[] = {scene, &alone, &few};
    adcgs_train_config config = small_config();
    adcgs_scene_view *views = malloc(n * sizeof *views);
    assert_true(views && n >= 2 * scene->n_times);
    memcpy(views, scene->views[ADCGS_SPLIT_TRAIN], n * sizeof *views);
    for (uint32_t i = 0; i < n; i++) /* in the second half of time cameras stand elsewhere, so that there are twice as many */
        views[i].camera.cam_to_world[3] += views[i].time > scene->duration / 2 ? 0.01 : 0;
    few.views[ADCGS_SPLIT_TRAIN] = views;
    alone.n_times = n;
    for (int by_hand = 0; by_hand < 2; by_hand++)
        for (int i = 0; i < 3; i++) {
            adcgs_trainer *t;
            if (by_hand)
                assert_int_equal(adcgs_train_set(&config, i ? "smooth_time=0" : "smooth_time=1", &error), ADCGS_OK);
            assert_int_equal(adcgs_trainer_create(&t, scenes[i], &config, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
            assert_int_equal(t->f->params.smooth_time, by_hand ? !i : i > 0);
            const adcgs_quantise_options how = {.cpu = t->cpu, .mu = t->pass->mu, .factor = t->pass->factor};
            adcgs_model model;
            t->f->is_part = 1; /* keeps motion in the stream even if nothing moves */
            adcgs_pass_forward(t->pass, t->f, 0.5f, &(adcgs_pass_mode){.quant = ADCGS_QUANT_ROUND});
            assert_int_equal(adcgs_quantise(&model, t->f, &how, &error), ADCGS_OK);
            assert_int_equal(model.params.smooth_time, t->f->params.smooth_time);
            adcgs_model_clear(&model, NULL);
            adcgs_trainer_free(&t);
        }
    adcgs_trainer *t;
    adcgs_train_config without = small_config(); /* as preset paper */
    without.params.smooth_time = 0;
    assert_int_equal(adcgs_trainer_create(&t, &few, &without, ADCGS_CPU_SCALAR, pool, &error), ADCGS_OK);
    assert_int_equal(t->f->params.smooth_time, 0);
    adcgs_trainer_free(&t);
    free(views);
}

/* ---- Time ---- */

/** The learning-rate scale of a kind applies to its groups and to no other. */
static void rates_follow_their_kind(void **state)
{
    adcgs_train_config config = small_config();
    static const int groups[] = {ADCGS_P_COLOUR, ADCGS_P_THETA, ADCGS_P_TIME, ADCGS_P_E_FV};
    adcgs_trainer *plain = make_trainer(&config, NULL), *told;
    const adcgs_status status =
        adcgs_train_set(&config, "lr_scale_anchors=2,lr_scale_prediction=3,lr_scale_motion=5,lr_scale_entropy=7", &error);
    assert_int_equal(status, ADCGS_OK);
    told = make_trainer(&config, NULL);
    for (int i = 0; i < 4; i++) {
        const adcgs_param *p = &plain->f->param[groups[i]], *q = &told->f->param[groups[i]];
        const float times = (const float[]){2, 3, 5, 7}[i];
        assert_true(p->lr0 > p->lr1 && p->lr1 > 0);
        assert_float_equal(q->lr0, times * p->lr0, 1e-6);
        assert_float_equal(q->lr1, times * p->lr1, 1e-6);
    }
    adcgs_trainer_free(&plain);
    adcgs_trainer_free(&told);
}

/** Learning rates are constant until lr_decay_start, then fall by equal factors in equal times. */
static void rates_stay_then_fall(void **state)
{
    adcgs_train_config c = {.lr_decay_start = 0.5f};
    for (int i = 0; i <= 2; i++)
        assert_float_equal(adcgs_train_rate(&c, 8, 2, 0.25 * i), 8, 0);
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 0.75), 4, 1e-6);
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 1), 2, 1e-6);
    c.lr_decay_start = 0;
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 0.5), 4, 1e-6);
    c.lr_decay_start = 2;
    assert_float_equal(adcgs_train_rate(&c, 8, 2, 1), 8, 0);
}

/** Seconds per iteration of an imaginary machine: this share of an iteration at full resolution is not spent on pixels. */
static double true_cost(int divide, double overhead)
{
    return 0.01 * (overhead + (1 - overhead) / (divide * divide));
}

/** The estimate of the remaining time is never negative, never rises by much, and is near the truth from the start on. */
static void time_left_follows_the_schedule(void **state)
{
    static const double overheads[] = {0.05, 0.2, 0.6, 1};
    static const float halves[][2] = {{0.25f, 0.7f}, {0, 0}, {0.3f, 0.3f}, {0, 0.5f}, {1, 1}};
    enum { N = 4000 };
    for (size_t o = 0; o < ADCGS_COUNTOF(overheads); o++)
        for (size_t h = 0; h < ADCGS_COUNTOF(halves); h++) {
            adcgs_train_config c = small_config();
            adcgs_time_left left = {.load = 0};
            c.iterations = N;
            c.quarter_size_until = halves[h][0];
            c.half_size_until = halves[h][1];
            assert_true(isnan(adcgs_time_left_of(&left, &c, 0, 0)));
            double truth = 0, before = HUGE_VAL;
            for (uint32_t i = 0; i < N; i++)
                truth += true_cost(adcgs_coarse_divide(&c, (double)i / N), overheads[o]);
            for (uint32_t i = 0; i < N; i++) {
                const int divide = adcgs_coarse_divide(&c, (double)i / N);
                const double cost = true_cost(divide, overheads[o]);
                adcgs_time_left_add(&left, divide, cost);
                truth -= cost;
                const double told = adcgs_time_left_of(&left, &c, i + 1, 0);
                const int last = divide == 1 || (double)i / N >= (double)halves[h][1];
                assert_true(told >= 0 && told < 4.1 * truth + 1e-9 && told > truth / 4.1 - 1e-9);
                assert_true(!last || fabs(told - truth) < 1e-6 * N);
                assert_true(told <= before || divide != adcgs_coarse_divide(&c, i ? (double)(i - 1) / N : 0));
                before = told;
            }
            assert_true(before < 1e-9);
            /* The time limit ends the run, with or without an estimate. After its end the remaining time is 0, not negative. */
            c.time_limit = 7;
            assert_true(adcgs_time_left_of(&left, &c, 0, 6.5) <= 0.5 && adcgs_time_left_of(&left, &c, 0, 99) == 0);
            left = (adcgs_time_left){.load = 0};
            assert_true(adcgs_time_left_of(&left, &c, 0, 3) == 4);
            assert_true(adcgs_time_left_of(&left, &c, N, 3) == 0);
        }
}

/** Future loading between resolutions counts. */
static void time_left_knows_loading(void **state)
{
    adcgs_train_config c = small_config();
    adcgs_time_left left = {.cost = {1, 1, 1}, .load = 100};
    c.iterations = 10;
    c.quarter_size_until = 0.2f;
    c.half_size_until = 0.5f;
    assert_true(adcgs_time_left_of(&left, &c, 0, 0) == 210);
    assert_true(adcgs_time_left_of(&left, &c, 3, 0) == 107);
    assert_true(adcgs_time_left_of(&left, &c, 9, 0) == 1);
}

/** The time limit counts from the start of the program. If it is over before the first iteration, there is no run. */
static void time_limits_count_what_was_before(void **state)
{
    adcgs_train_config config = small_config();
    int stopped;
    config.time_limit = 5;
    adcgs_trainer *t = make_trainer(&config, pool);
    t->run.started.clock = adcgs_seconds() - 6;
    assert_int_equal(adcgs_trainer_run(t, NULL, NULL, &stopped, &error), ADCGS_ERR_USAGE);
    assert_int_equal(t->run.iteration, 0);
    assert_true(strstr(error.text, "time limit of 5 s") && strstr(error.text, "before training began"));
    adcgs_trainer_free(&t);
    /* The remaining time is many times that of a short run, however busy the machine is. */
    config.time_limit = 0;
    config.iterations = 10;
    const double begin = adcgs_seconds();
    t = make_trainer(&config, pool);
    run(t, NULL, NULL);
    adcgs_trainer_free(&t);
    const double left = fmax(1, 5 * (adcgs_seconds() - begin));
    config.time_limit = 10000;
    config.iterations = 1000000;
    t = make_trainer(&config, pool);
    t->run.started.clock = adcgs_seconds() - (config.time_limit - left);
    run(t, NULL, NULL);
    assert_true(t->run.iteration > 0 && t->run.iteration < config.iterations);
    assert_true(t->run.elapsed.clock >= config.time_limit && t->run.elapsed.cpu > 0);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stages_follow_their_settings),
        cmocka_unit_test(displayed_stages_follow_the_table),
        cmocka_unit_test(windows_grow_outwards),
        cmocka_unit_test(averages_are_means),
        cmocka_unit_test(moments_shared_by_views_change_settings),
        cmocka_unit_test(few_cameras_make_time_smooth),
        cmocka_unit_test(rates_stay_then_fall),
        cmocka_unit_test(rates_follow_their_kind),
        cmocka_unit_test(time_left_follows_the_schedule),
        cmocka_unit_test(time_left_knows_loading),
        cmocka_unit_test(time_limits_count_what_was_before),
    };
    return cmocka_run_group_tests_name("schedule", tests, open_scene, close_scene);
}
