/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rate control: the plan for a size, how lambda adapts, the final size or quality, and that stopping changes nothing. */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "train/density/sample.h"
#include "train/rate/rate_control.h"
#include "train/resolve.h"
#include "train/rate/rate_search.h"

static adcgs_train_config config_for(adcgs_train_target target, double value)
{
    adcgs_train_config c;
    assert_int_equal(adcgs_train_preset(&c, "draft", &error), ADCGS_OK);
    c.iterations = ITERATIONS;
    c.start_anchors = 100;
    c.densify_interval = 20;
    c.matching_frames = 0; /* stereo would run again for each trainer; only the stream's size counts here */
    c.params.n_fg = 8;     /* so that a size can be used up */
    c.densify_threshold = 1e-6f;
    c.freeze_start = 0.92f; /* long enough to stop in */
    c.target = target;
    c.target_value = value;
    return c;
}

/* ---- The plan ---- */

static void plans_grow_with_the_size(void **state)
{
    uint32_t anchors = 0;
    int widths = 0;
    for (double size = 8000; size < 4e6; size *= 1.5) {
        adcgs_train_config c = config_for(ADCGS_TARGET_SIZE, size);
        const adcgs_train_config before = c;
        if (adcgs_resolve_target(&c, &error) != ADCGS_OK)
            fail_msg("%.0f: %s", size, error.text);
        const int sum = c.shape.theta_width + c.shape.omega_width + c.shape.varpi_width + c.shape.entropy_width;
        assert_true(c.max_anchors >= anchors && sum >= widths);
        assert_true(c.start_anchors <= c.max_anchors && c.shape.omega_width <= before.shape.omega_width);
        anchors = c.max_anchors;
        widths = sum;
    }
    const adcgs_train_config preset = config_for(ADCGS_TARGET_NONE, 0);
    assert_int_equal(widths,
                     preset.shape.theta_width + preset.shape.omega_width + preset.shape.varpi_width + preset.shape.entropy_width);
    assert_true(anchors > preset.max_anchors);
}

static void plans_leave_what_was_chosen(void **state)
{
    adcgs_train_config c = config_for(ADCGS_TARGET_SIZE, 60000);
    assert_int_equal(adcgs_train_set(&c, "max_anchors=77,theta_width=31", &error), ADCGS_OK);
    const adcgs_shape shape = c.shape;
    assert_int_equal(adcgs_resolve_target(&c, &error), ADCGS_OK);
    assert_int_equal(c.max_anchors, 77);
    assert_int_equal(c.start_anchors, 77);
    assert_memory_equal(&shape, &c.shape, sizeof shape);
}

static void sizes_too_small_are_refused(void **state)
{
    adcgs_train_config c = config_for(ADCGS_TARGET_SIZE, 2500);
    assert_int_equal(adcgs_resolve_target(&c, &error), ADCGS_ERR_USAGE);
    assert_non_null(strstr(error.text, "too few"));
    c = config_for(ADCGS_TARGET_PSNR, 30);
    c.lambda = 0;
    assert_int_equal(adcgs_resolve_target(&c, &error), ADCGS_OK);
    assert_true(c.lambda > 0);
}

/* ---- Lambda ---- */

static adcgs_trainer *make(const adcgs_train_config *config, adcgs_train_measure measure)
{
    adcgs_trainer *t;
    if (adcgs_trainer_create(&t, scene, config, adcgs_cpu_best(), pool, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    t->quantise = adcgs_encode_quantise_hook;
    t->rate.measure = measure;
    return t;
}

static adcgs_status pretended_bytes(void *user, const adcgs_trainer *t, adcgs_bytes *bytes, adcgs_error *e)
{
    (void)t;
    (void)e;
    *bytes = (adcgs_bytes){.networks = 10000, .layer = {*(const uint64_t *)user}, .total = 10000 + *(const uint64_t *)user};
    return ADCGS_OK;
}

/** Too many bytes raise lambda step by step up to a bound, where anchors are pruned. Too few lower it. */
static void lambda_follows_the_bytes(void **state)
{
    adcgs_train_config config = config_for(ADCGS_TARGET_SIZE, 60000);
    config.time_limit = 1000; /* prevents the search for lambda beforehand */
    for (int much = 0; much < 2; much++) {
        uint64_t features = much ? 200000 : 10000;
        adcgs_trainer *t = make(&config, pretended_bytes);
        const uint32_t n = t->f->n;
        t->rate.measure_user = &features;
        t->rate.mean_bits[0] = 8.0 * (double)features;
        t->stats.n = 1000;
        double last = t->rate.lambda;
        for (int i = 0; i < 40; i++) {
            t->run.iteration = (uint32_t)(60 + 10 * i);
            assert_int_equal(adcgs_rate_control_step(t, 0.3 + 0.01 * i, &error), ADCGS_OK);
            assert_true(much ? t->rate.lambda >= last : t->rate.lambda <= last);
            last = t->rate.lambda;
            t->stats.n = 1000;
        }
        assert_true(much ? last > 20 * (double)t->config.lambda : last < 0.05 * (double)t->config.lambda);
        assert_true(much ? t->f->n < n / 2 && t->f->n > 0 : t->f->n == n);
        adcgs_trainer_free(&t);
    }
}

/** Features of a run at its lambda; *user is the lambda at which they have 50,000 bytes. */
static adcgs_status bytes_of_lambda(void *user, const adcgs_trainer *t, adcgs_bytes *bytes, adcgs_error *e)
{
    uint64_t features = (uint64_t)(50000 * pow(t->rate.lambda / *(const double *)user, -0.3));
    return pretended_bytes(&features, t, bytes, e);
}

/** If the bytes do not fit, another lambda is tried from the start of the rate, until one fits; not with a time limit. */
static void lambda_is_sought(void **state)
{
    adcgs_train_config config = config_for(ADCGS_TARGET_SIZE, 60000);
    for (int large = 0; large < 2; large++) {
        adcgs_trainer *t = make(&config, bytes_of_lambda);
        double right = (double)config.lambda * (large ? 20 : 0.05);
        uint32_t tries = 0;
        t->rate.measure_user = &right;
        t->run.iteration = 77;
        const float begin = t->f->param[ADCGS_P_FV].p[0];
        while (adcgs_rate_is_sought(t)) {
            assert_true(t->run.iteration == 77 && t->f->param[ADCGS_P_FV].p[0] == begin);
            assert_int_equal(adcgs_rate_search_step(t, 0.31, &error), ADCGS_OK);
            t->f->param[ADCGS_P_FV].p[0] = 5;
            t->rate.mean_bits[0] = 8.0 * 50000 * pow(t->rate.lambda / right, -0.3);
            t->run.iteration = 150;
            assert_int_equal(adcgs_rate_search_step(t, 0.59, &error), ADCGS_OK);
            assert_int_equal(t->run.iteration, 150);
            assert_int_equal(adcgs_rate_search_step(t, 0.63, &error), ADCGS_OK);
            assert_int_equal(t->run.iteration, 150); /* the loop returns, not the step */
            if (t->rate.next_lambda > 0)
                assert_int_equal(adcgs_rate_search_return(t, &error), ADCGS_OK);
            tries++;
        }
        print_message("%u tries: %g times the right lambda\n", tries, t->rate.lambda / right);
        assert_true(tries > 1 && t->run.iteration == 150 && t->rate.begin.size == 0);
        assert_true(fabs(log(t->rate.lambda / right)) < 0.5);
        adcgs_trainer_free(&t);
    }
    config.time_limit = 1000;
    adcgs_trainer *t = make(&config, bytes_of_lambda);
    assert_false(adcgs_rate_is_sought(t));
    adcgs_trainer_free(&t);
}

/** A quality missed at the end causes one more run with a smaller lambda. A quality that is met, or missed again, does not. */
static void test_missed_quality_is_tried_again(void **state)
{
    const adcgs_train_config config = config_for(ADCGS_TARGET_PSNR, 30);
    for (int missed = 0; missed < 2; missed++) {
        adcgs_trainer *t = make(&config, pretended_bytes);
        t->run.iteration = 77;
        assert_int_equal(adcgs_rate_search_step(t, 0.31, &error), ADCGS_OK);
        t->run.iteration = 190;
        t->rate.control.tried = t->rate.lambda;
        t->rate.control.tries = 1000;
        assert_false(adcgs_rate_is_sought(t));
        adcgs_rate_search_end(t, missed ? 0.5 : -0.5);
        assert_true(t->run.iteration == 190 && missed == (t->rate.next_lambda > 0));
        if (missed)
            assert_int_equal(adcgs_rate_search_return(t, &error), ADCGS_OK);
        assert_true(t->run.iteration == (missed ? 77 : 190) && !(t->rate.next_lambda > 0));
        assert_true(missed ? t->rate.lambda < t->rate.control.tried && adcgs_rate_is_sought(t) : t->rate.begin.size == 0);
        t->run.iteration = 190;
        adcgs_rate_search_end(t, 0.5);
        assert_true(!(t->rate.next_lambda > 0) && t->rate.begin.size == 0);
        adcgs_trainer_free(&t);
    }
}

/* ---- Final size and quality ---- */

static adcgs_status real_bytes(void *user, const adcgs_trainer *t, adcgs_bytes *bytes, adcgs_error *e)
{
    (void)user;
    return adcgs_encode_bytes(bytes, t, -1, NULL, 0, e);
}

static uint64_t final_bytes(const adcgs_trainer *t)
{
    adcgs_bytes bytes;
    assert_int_equal(adcgs_encode_bytes(&bytes, t, -1, NULL, 0, &error), ADCGS_OK);
    return bytes.total;
}

/** More anchors than a size can hold after so short a run: levels or anchors have to be reduced. */
static adcgs_train_config roomy_config(adcgs_train_target target, double value)
{
    adcgs_train_config c = config_for(target, value);
    assert_int_equal(adcgs_train_set_value(&c, "max_anchors", 800, &error), ADCGS_OK);
    c.start_anchors = 100;
    return c;
}

static void runs_land_on_sizes(void **state)
{
    for (int size = 8000; size <= 16000; size += 8000) {
        const adcgs_train_config config = roomy_config(ADCGS_TARGET_SIZE, size);
        adcgs_trainer *t = make(&config, real_bytes);
        run_trainer(t, NULL, NULL);
        const uint64_t bytes = final_bytes(t);
        print_message("target %d bytes, result %llu bytes\n", size, (unsigned long long)bytes);
        assert_true(bytes <= (uint64_t)size && bytes > 0.97 * size);
        adcgs_trainer_free(&t);
    }
}

/** A run that never rounded its values, as one short of time, still meets its size. */
static void runs_land_without_rounding(void **state)
{
    adcgs_train_config config = roomy_config(ADCGS_TARGET_SIZE, 12000);
    config.quant_round_start = config.freeze_start = 1.5f;
    adcgs_trainer *t = make(&config, real_bytes);
    run_trainer(t, NULL, NULL);
    print_message("target 12000 bytes, result %llu bytes\n", (unsigned long long)final_bytes(t));
    assert_true(final_bytes(t) <= 12000 && final_bytes(t) > 0.97 * 12000);
    adcgs_trainer_free(&t);
}

static void runs_land_on_qualities(void **state)
{
    const adcgs_train_config config = roomy_config(ADCGS_TARGET_PSNR, 22);
    adcgs_trainer *t = make(&config, real_bytes);
    double psnr;
    run_trainer(t, NULL, NULL);
    assert_int_equal(adcgs_sample_psnr(t, UINT32_MAX, &psnr, &error), ADCGS_OK);
    print_message("target 22 dB, result %.3f dB\n", psnr);
    assert_true(psnr > 21.95 && psnr < 22.05);
    adcgs_trainer_free(&t);
}

/** Runs to the end through every stop. Each time a new trainer continues from the stored state. */
static adcgs_trainer *run_in_pieces(const adcgs_train_config *config)
{
    static const uint32_t stops[] = {50, 70, 130, 180, 190};
    adcgs_trainer *t = make(config, real_bytes);
    for (size_t i = 0; i < ADCGS_COUNTOF(stops); i++) {
        uint32_t stop = stops[i];
        adcgs_buffer middle;
        adcgs_buffer_init(&middle);
        run_trainer(t, stop_at, &stop);
        assert_int_equal(t->run.iteration, stop);
        assert_int_equal(adcgs_trainer_store(t, &middle, &error), ADCGS_OK);
        adcgs_trainer_free(&t);
        t = make(config, real_bytes);
        assert_int_equal(adcgs_trainer_restore(t, middle.data, middle.size, &error), ADCGS_OK);
        adcgs_buffer_clear(&middle);
    }
    run_trainer(t, NULL, NULL);
    return t;
}

/** A run that stops anywhere and continues from its stored state ends like a run that never stops. */
static void stopping_changes_nothing(void **state)
{
    static const double values[] = {[ADCGS_TARGET_SIZE] = 12000, [ADCGS_TARGET_PSNR] = 22};
    for (int target = ADCGS_TARGET_SIZE; target <= ADCGS_TARGET_PSNR; target++) {
        adcgs_train_config config = roomy_config((adcgs_train_target)target, values[target]);
        config.max_anchors = 300; /* bytes need not meet the target, only be the same */
        adcgs_trainer *through = make(&config, real_bytes), *pieces = run_in_pieces(&config);
        run_trainer(through, NULL, NULL);
        assert_true(pieces->rate.lambda == through->rate.lambda && final_bytes(pieces) == final_bytes(through));
        assert_memory_equal(pieces->f->param[ADCGS_P_FV].p, through->f->param[ADCGS_P_FV].p,
                            pieces->f->param[ADCGS_P_FV].n * sizeof(float));
        adcgs_trainer_free(&through);
        adcgs_trainer_free(&pieces);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plans_grow_with_the_size),
        cmocka_unit_test(plans_leave_what_was_chosen),
        cmocka_unit_test(sizes_too_small_are_refused),
        cmocka_unit_test(lambda_follows_the_bytes),
        cmocka_unit_test(lambda_is_sought),
        cmocka_unit_test(test_missed_quality_is_tried_again),
        cmocka_unit_test(runs_land_on_sizes),
        cmocka_unit_test(runs_land_without_rounding),
        cmocka_unit_test(runs_land_on_qualities),
        cmocka_unit_test(stopping_changes_nothing),
    };
    return cmocka_run_group_tests_name("control", tests, open_scene, close_scene);
}
