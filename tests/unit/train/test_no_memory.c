/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Out of memory: each allocation of opening a scene, training and encoding fails once, and has no consequence except the error.
 */
#include "tiny_scene.h"

#include "encode/encode.h"
#include "train/batch.h"
#include "train/stages.h"
#include "train/static/prune_and_fix.h"
#include "train/static/unit_prune.h"

#include <limits.h>
#include <malloc.h>
#include <stdatomic.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);

/* Number of allocations that still succeed (below 0: nothing fails), and their total. */
static atomic_long left = -1;
static atomic_long allocations = 0;

static int fails(void)
{
    atomic_fetch_add(&allocations, 1);
    return atomic_load(&left) >= 0 && atomic_fetch_sub(&left, 1) == 0;
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : __real_calloc(count, size);
}

/** Only new and growing blocks fail: a shrinking block can stay where it is. */
void *__wrap_realloc(void *old, size_t size)
{
    return (!old || size > malloc_usable_size(old)) && fails() ? NULL : __real_realloc(old, size);
}

/** A run of some iterations through every stage. */
static adcgs_train_config short_config(void)
{
    adcgs_train_config c = small_config();
    c.iterations = 24;
    c.start_anchors = 70;
    c.max_anchors = 140;
    c.densify_interval = 3;
    c.freeze_start = 0.90f;
    c.static_threshold = 1;
    c.rigidity_weight = 0.02f;
    c.shape.theta_width = c.shape.omega_width = c.shape.varpi_width = c.shape.entropy_width = 8;
    return c;
}

/* ---- The attempts ---- */

static adcgs_status try_scene(void)
{
    const adcgs_scene_options options = {.points_path = NULL};
    const adcgs_image_store_config pictures_config = {.split = ADCGS_SPLIT_TRAIN, .divide = 2};
    adcgs_scene *own = NULL;
    adcgs_image_store *pictures = NULL;
    adcgs_status status = adcgs_scene_open(&own, folder, &options, &error);
    if (status == ADCGS_OK)
        status = adcgs_image_store_load(&pictures, own, &pictures_config, NULL, &error);
    adcgs_image_store_free(&pictures);
    adcgs_scene_free(&own);
    return status;
}

static adcgs_status create_trainer(adcgs_trainer **t)
{
    const adcgs_train_config config = short_config();
    const adcgs_status status = adcgs_trainer_create(t, scene, &config, adcgs_cpu_best(), NULL, &error);
    if (status == ADCGS_OK)
        (*t)->quantise = adcgs_encode_quantise_hook;
    return status;
}

static adcgs_status try_create(void)
{
    adcgs_trainer *t = NULL;
    const adcgs_status status = create_trainer(&t);
    adcgs_trainer_free(&t);
    return status;
}

/** Half-way, calls the stages that so short a run leaves out. */
static adcgs_status run_stages(adcgs_trainer *t)
{
    const uint32_t half = 16;
    int stopped;
    ADCGS_TRY(adcgs_trainer_run(t, stop_at, (void *)(uintptr_t)&half, &stopped, &error));
    ADCGS_TRY(adcgs_test_motion_gain(t, &error));
    ADCGS_TRY(adcgs_prune_units(t, &error));
    return adcgs_trainer_run(t, NULL, NULL, &stopped, &error);
}

static adcgs_status write_and_read(const adcgs_trainer *t)
{
    adcgs_stream stream;
    adcgs_buffer out;
    adcgs_stream_init(&stream);
    adcgs_buffer_init(&out);
    adcgs_status status = adcgs_encode_stream(&stream, t, NULL, 0, &error);
    if (status == ADCGS_OK)
        status = adcgs_encode_verified(&stream, &out, adcgs_cpu_best(), NULL, &error);
    adcgs_buffer_clear(&out);
    adcgs_stream_clear(&stream, NULL);
    return status;
}

static adcgs_status try_run(void)
{
    adcgs_trainer *t = NULL;
    adcgs_buffer saved;
    adcgs_buffer_init(&saved);
    adcgs_status status = create_trainer(&t);
    if (status == ADCGS_OK)
        status = run_stages(t);
    if (status == ADCGS_OK)
        status = adcgs_trainer_store(t, &saved, &error);
    if (status == ADCGS_OK)
        status = adcgs_trainer_restore(t, saved.data, saved.size, &error);
    if (status == ADCGS_OK)
        status = write_and_read(t);
    adcgs_buffer_clear(&saved);
    adcgs_trainer_free(&t);
    return status;
}

/* ---- The trial ---- */

/** Lets allocations fail, one per attempt, at most `most` of them, spread evenly. */
static void each_fails(adcgs_status (*attempt)(void), long most)
{
    atomic_store(&allocations, 0);
    assert_int_equal(attempt(), ADCGS_OK);
    const long n = atomic_load(&allocations), tries = ADCGS_MIN(n, most);
    assert_true(n > 20);
    for (long i = 0; i < tries; i++) {
        error = (adcgs_error){ADCGS_OK, ""};
        atomic_store(&left, n * i / tries);
        const adcgs_status status = attempt();
        atomic_store(&left, -1);
        if (status != ADCGS_ERR_MEMORY || error.status != status || !error.text[0])
            fail_msg("allocation %ld of %ld: status %d, '%s'", n * i / tries, n, (int)status, error.text);
    }
    print_message("%ld of %ld allocations failed once\n", tries, n);
}

static void scenes(void **state)
{
    (void)state;
    each_fails(try_scene, LONG_MAX);
}

static void trainers(void **state)
{
    (void)state;
    each_fails(try_create, LONG_MAX);
}

static void runs_and_streams(void **state)
{
    (void)state;
    each_fails(try_run, getenv("ADCGS_FULL") ? 80 : 40);
}

/** Memory of several view passes per iteration in addition to the run's: sums, and the means before. */
static void looks(void **state)
{
    adcgs_train_config config = short_config();
    adcgs_trainer *t;
    adcgs_status status;
    long tries = 0;
    (void)state;
    config.batch = 3;
    assert_int_equal(adcgs_trainer_create(&t, scene, &config, adcgs_cpu_best(), NULL, &error), ADCGS_OK);
    assert_int_equal(adcgs_stages_before(t, 0, &error), ADCGS_OK);
    t->stage.rounding = 1;
    do {
        atomic_store(&left, tries++);
        status = adcgs_batch_run(t, 0.9, &error);
        atomic_store(&left, -1);
        assert_true(status == ADCGS_OK || status == ADCGS_ERR_MEMORY);
    } while (status != ADCGS_OK);
    assert_true(tries > 3);
    adcgs_trainer_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes),
        cmocka_unit_test(trainers),
        cmocka_unit_test(runs_and_streams),
        cmocka_unit_test(looks),
    };
    return cmocka_run_group_tests(tests, open_scene, close_scene);
}
