/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs that fail after their first iteration: the saved state leads to the end of a run without the failure. */
#include "tiny_scene.h"

static adcgs_buffer end; /* the state at the end of an undisturbed run */

static void run_to_end(adcgs_trainer *t)
{
    int stopped;
    if (adcgs_trainer_run(t, NULL, NULL, &stopped, &error) != ADCGS_OK)
        fail_msg("%s", error.text);
}

static int open_and_run(void **state)
{
    if (open_scene(state))
        return -1;
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    run_to_end(t);
    store(t, &end);
    adcgs_trainer_free(&t);
    return 0;
}

static int forget_and_close(void **state)
{
    adcgs_buffer_clear(&end);
    return close_scene(state);
}

/** Expects a failed run to save the state of an iteration, and a run that continues from it to end like the undisturbed one. */
static void expect_rescued(adcgs_trainer *failed, uint32_t iteration)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_buffer other;
    assert_int_equal(adcgs_trainer_rescued(failed), iteration);
    assert_int_equal(adcgs_trainer_rescue(failed, in("state"), &error), ADCGS_OK);
    if (adcgs_trainer_load(t, in("state"), &error) != ADCGS_OK)
        fail_msg("%s", error.text);
    assert_int_equal(t->run.iteration, iteration);
    run_to_end(t);
    store(t, &other);
    assert_int_equal(end.size, other.size);
    assert_memory_equal(end.data, other.data, end.size);
    adcgs_buffer_clear(&other);
    adcgs_trainer_free(&t);
}

static int fail_later(void *user, uint32_t done, uint32_t n)
{
    const adcgs_trainer *const t = user;
    (void)done;
    (void)n;
    return t->run.iteration > 0;
}

/** Images of the next size cannot be loaded. */
static void loading_fails(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    int stopped;
    (void)state;
    t->views.loading = fail_later;
    t->views.loading_user = t;
    assert_int_equal(adcgs_trainer_run(t, NULL, NULL, &stopped, &error), ADCGS_ERR_IO);
    assert_true(t->run.iteration > 0 && t->run.iteration < ITERATIONS);
    expect_rescued(t, t->run.iteration);
    adcgs_trainer_free(&t);
}

/** An observer: from iteration 20 on an image is missing. */
static int take_away(void *user, const adcgs_train_report *r)
{
    const char *const path = user;
    if (r->iteration == 20)
        assert_int_equal(rename(path, in("away")), 0);
    return 0;
}

/** Images are not kept, and one cannot be read again. */
static void an_image_goes_away(void **state)
{
    const adcgs_train_config config = small_config();
    char *const before = getenv("TMPDIR") ? strdup(getenv("TMPDIR")) : NULL;
    char *const path = scene->views[ADCGS_SPLIT_TRAIN][3].path;
    adcgs_trainer *t = make_trainer(&config, pool);
    int stopped;
    (void)state;
    t->views.memory = 1;
    setenv("TMPDIR", in("nowhere"), 1);
    assert_int_equal(adcgs_trainer_run(t, take_away, path, &stopped, &error), ADCGS_ERR_IO);
    assert_non_null(strstr(error.text, path));
    before ? setenv("TMPDIR", before, 1) : unsetenv("TMPDIR");
    free(before);
    assert_int_equal(rename(in("away"), path), 0);
    assert_true(t->run.iteration >= 20 && t->run.iteration < ITERATIONS);
    expect_rescued(t, t->run.iteration);
    adcgs_trainer_free(&t);
}

/** A failed save near the end, where parameters are averaged, does not change the run. */
static void a_full_disk_changes_nothing(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    adcgs_buffer before, after;
    uint32_t stop = ITERATIONS - 10; /* reports come every ten */
    int stopped;
    (void)state;
    assert_int_equal(adcgs_trainer_run(t, stop_at, &stop, &stopped, &error), ADCGS_OK);
    assert_true(t->average.n > 0);
    store(t, &before);
    assert_int_equal(adcgs_trainer_save(t, "/dev/full", &error), ADCGS_ERR_IO);
    store(t, &after);
    assert_int_equal(before.size, after.size);
    assert_memory_equal(before.data, after.data, before.size);
    adcgs_buffer_clear(&before);
    adcgs_buffer_clear(&after);
    adcgs_trainer_free(&t);
}

/** Writing the result fails: the end is applied again. */
static void writing_fails(void **state)
{
    const adcgs_train_config config = small_config();
    adcgs_trainer *t = make_trainer(&config, pool);
    (void)state;
    run_to_end(t);
    expect_rescued(t, ITERATIONS);
    adcgs_trainer_free(&t);
}

static adcgs_status quantise_nothing(const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *e)
{
    (void)f;
    (void)options;
    return adcgs_fail(e, ADCGS_ERR_MEMORY, "out of memory for this");
}

/** In the middle of a change the state before it is saved, if it is that of an iteration. */
static void a_change_fails(void **state)
{
    const adcgs_train_config config = small_config();
    (void)state;
    for (uint32_t from = 0; from <= 30; from += 30) {
        adcgs_trainer *t = make_trainer(&config, pool);
        int stopped;
        assert_int_equal(adcgs_trainer_run(t, stop_at, &from, &stopped, &error), ADCGS_OK);
        t->quantise = quantise_nothing;
        assert_int_equal(adcgs_trainer_run(t, NULL, NULL, &stopped, &error), ADCGS_ERR_MEMORY);
        assert_true(t->run.iteration > 30);
        if (from)
            expect_rescued(t, from);
        else {
            assert_int_equal(adcgs_trainer_rescued(t), 0);
            assert_int_equal(adcgs_trainer_rescue(t, in("none"), &error), ADCGS_ERR_DATA);
            assert_int_equal(access(in("none"), F_OK), -1);
        }
        adcgs_trainer_free(&t);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loading_fails), cmocka_unit_test(an_image_goes_away), cmocka_unit_test(a_full_disk_changes_nothing),
        cmocka_unit_test(writing_fails), cmocka_unit_test(a_change_fails),
    };
    return cmocka_run_group_tests_name("rescue", tests, open_and_run, forget_and_close);
}
