/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Threads that decoders share or borrow: the same frames for any threads, in any order and rounding mode. */
#include "config.h"

#include "decoder_fixture.h"

#include <fenv.h>
#include <pthread.h>

#define TASKS_MOST 8
#define ROUNDS 20

static float reference[3 * FIXTURE_WIDTH * FIXTURE_HEIGHT];

static adcgs_decoder *open_in(const fixture *f, adcgs_pool *pool)
{
    adcgs_config config;
    adcgs_config_init(&config, sizeof config);
    config.pool = pool;
    config.threads = pool ? 12345 : 1; /* ignored if there is a pool */
    return open_with(f, &config);
}

/** Contains no assertion of the framework, since it also runs in other threads. */
static int draws_reference(adcgs_decoder *d)
{
    float rgb[3 * FIXTURE_WIDTH * FIXTURE_HEIGHT];
    adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, rgb};
    return adcgs_render(d, &fixture_camera, 0.045, &frame, NULL) == ADCGS_OK && memcmp(rgb, reference, sizeof rgb) == 0;
}

static int setup_reference(void **state)
{
    adcgs_frame frame = {FIXTURE_WIDTH, FIXTURE_HEIGHT, reference};
    if (setup(state))
        return -1;
    adcgs_decoder *d = open_in(*state, NULL);
    const adcgs_status status = adcgs_render(d, &fixture_camera, 0.045, &frame, NULL);
    adcgs_close(&d);
    return status;
}

typedef struct user {
    adcgs_decoder *decoder;
    int wrong;
} user;

static void *use(void *arg)
{
    user *u = arg;
    for (int i = 0; i < ROUNDS; i++)
        u->wrong += !draws_reference(u->decoder);
    return NULL;
}

static void test_shared_pool(void **state)
{
    adcgs_pool *pool;
    user users[3] = {{0}};
    pthread_t threads[3];
    assert_int_equal(adcgs_pool_create(&pool, 3, NULL), ADCGS_OK);
    for (int i = 0; i < 3; i++)
        users[i].decoder = open_in(*state, pool);
    for (int i = 0; i < 3; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, use, &users[i]), 0);
    for (int i = 0; i < 3; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(users[i].wrong, 0);
    }
    adcgs_close(&users[0].decoder);
    adcgs_close(&users[1].decoder);
    assert_true(draws_reference(users[2].decoder)); /* the pool outlives its users */
    adcgs_close(&users[2].decoder);
    adcgs_pool_free(&pool);
    assert_null(pool);
}

/** A caller's threads: how they run tasks, and statistics. */
typedef struct lender {
    int threads, mode;
    int calls, most, modes_kept;
} lender;

static void run_backwards(void *arg, adcgs_task_fn task, void *work, int n)
{
    lender *l = arg;
    l->calls++;
    l->most = ADCGS_MAX(l->most, n);
    while (n-- > 0)
        task(work, n);
}

typedef struct lent_thread {
    adcgs_task_fn task;
    void *work;
    int number, mode, kept;
} lent_thread;

static void *lent_main(void *arg)
{
    lent_thread *t = arg;
    fesetround(t->mode);
    t->task(t->work, t->number);
    t->kept = fegetround() == t->mode;
    return NULL;
}

/** A thread for each task, in the lender's rounding mode. */
static void run_on_threads(void *arg, adcgs_task_fn task, void *work, int n)
{
    lender *l = arg;
    lent_thread threads[TASKS_MOST];
    pthread_t ids[TASKS_MOST];
    l->calls++;
    l->most = ADCGS_MAX(l->most, n);
    for (int i = 0; i < n; i++) {
        threads[i] = (lent_thread){task, work, i, l->mode, 0};
        if (pthread_create(&ids[i], NULL, lent_main, &threads[i]))
            abort();
    }
    for (int i = 0; i < n; i++) {
        pthread_join(ids[i], NULL);
        l->modes_kept += threads[i].kept;
    }
}

static void lend(const fixture *f, adcgs_run_fn run, lender *l)
{
    adcgs_pool *pool;
    assert_int_equal(adcgs_pool_wrap(&pool, l->threads, run, l, NULL), ADCGS_OK);
    assert_int_equal(adcgs_pool_threads(pool), l->threads);
    adcgs_decoder *d = open_in(f, pool);
    assert_true(draws_reference(d));
    adcgs_close(&d);
    adcgs_pool_free(&pool);
    assert_true(l->calls > 3 && l->most <= l->threads && l->most > 1);
}

static void test_lent_threads(void **state)
{
    lender one_by_one = {.threads = 5};
    lender plain = {.threads = 3, .mode = FE_TONEAREST}, upward = {.threads = TASKS_MOST, .mode = FE_UPWARD};
    lend(*state, run_backwards, &one_by_one);
    lend(*state, run_on_threads, &plain);
    lend(*state, run_on_threads, &upward);
    assert_true(upward.modes_kept > upward.calls); /* each thread has its own mode back */
}

/** Threads that a pool starts do not inherit the rounding mode of its creator. */
static void test_pool_made_in_another_mode(void **state)
{
    adcgs_pool *pool;
    fesetround(FE_DOWNWARD);
    const adcgs_status status = adcgs_pool_create(&pool, 4, NULL);
    fesetround(FE_TONEAREST);
    assert_int_equal(status, ADCGS_OK);
    adcgs_decoder *d = open_in(*state, pool);
    for (int i = 0; i < ROUNDS; i++)
        assert_true(draws_reference(d));
    adcgs_close(&d);
    adcgs_pool_free(&pool);
}

static void test_bounds(void **state)
{
    adcgs_pool *pool;
    (void)state;
    assert_int_equal(adcgs_pool_wrap(&pool, 0, run_backwards, NULL, NULL), ADCGS_ERR_USAGE);
    assert_null(pool);
    assert_int_equal(adcgs_pool_wrap(&pool, ADCGS_THREADS_MAX + 1, run_backwards, NULL, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_pool_wrap(&pool, 2, NULL, NULL, NULL), ADCGS_ERR_USAGE);
    assert_int_equal(adcgs_pool_threads(NULL), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shared_pool),
        cmocka_unit_test(test_lent_threads),
        cmocka_unit_test(test_pool_made_in_another_mode),
        cmocka_unit_test(test_bounds),
    };
    return cmocka_run_group_tests(tests, setup_reference, teardown);
}
