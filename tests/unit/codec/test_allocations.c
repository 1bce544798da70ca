/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Every allocation of the decoder, and every start of a thread, fails once; tasks of a pool allocate nothing. */
#include "random_model.h"

#include "base/thread_pool.h"

#include <adcgs/adcgs.h>

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>

#include <cmocka.h>

void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void __real_free(void *block);
int __real_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*function)(void *), void *arg);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void __wrap_free(void *block);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*function)(void *), void *arg);

/* Number of allocations that still succeed (below 0: nothing fails); blocks in use. */
static atomic_long left = -1;
static atomic_long blocks = 0;
/* True while a task of a pool runs; number of allocator calls by tasks. The allocator need not be thread-safe. */
static atomic_int in_task = 0, task_calls = 0;
/* Threads that were not started. */
static atomic_int denied = 0;

static int fails(void)
{
    return atomic_load(&left) >= 0 && atomic_fetch_sub(&left, 1) == 0;
}

void *__wrap_calloc(size_t count, size_t size)
{
    void *block = fails() ? NULL : __real_calloc(count, size);
    atomic_fetch_add(&blocks, block != NULL);
    atomic_fetch_add(&task_calls, in_task);
    return block;
}

void *__wrap_realloc(void *old, size_t size)
{
    void *block = fails() ? NULL : __real_realloc(old, size);
    atomic_fetch_add(&blocks, block != NULL && old == NULL);
    atomic_fetch_add(&task_calls, in_task);
    return block;
}

void __wrap_free(void *block)
{
    atomic_fetch_sub(&blocks, block != NULL);
    atomic_fetch_add(&task_calls, in_task);
    __real_free(block);
}

int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*function)(void *), void *arg)
{
    const int fails_now = fails();
    atomic_fetch_add(&denied, fails_now);
    return fails_now ? 11 : __real_pthread_create(id, attributes, function, arg);
}

static const adcgs_camera camera = {.width = 33,
                                    .height = 20,
                                    .fx = 30,
                                    .fy = 30,
                                    .cx = 16,
                                    .cy = 10,
                                    .near_plane = 0.01,
                                    .cam_to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4}};

/**
 * Opens, renders at two times and closes while allocation n fails, or the start of a thread, which is no failure. Returns true if
 * an allocation has failed.
 */
static int fail_allocation(const adcgs_buffer *bytes, int threads, long n)
{
    float rgb[33 * 20 * 3];
    uint8_t pixels[33 * 20 * 4];
    adcgs_frame frame = {33, 20, rgb};
    adcgs_error error = {ADCGS_OK, ""};
    adcgs_config config;
    adcgs_decoder *d = NULL;
    adcgs_config_init(&config, sizeof config);
    config.threads = threads;
    const long before = atomic_load(&blocks);
    const int denied_before = atomic_load(&denied);
    atomic_store(&left, n);
    adcgs_status status = adcgs_open_memory(&d, bytes->data, bytes->size, &config, &error);
    if (status == ADCGS_OK)
        status = adcgs_render(d, &camera, 0, &frame, &error);
    if (status == ADCGS_OK)
        status = adcgs_render_rgba8(d, &camera, 0, ADCGS_ALPHA_PREMULTIPLIED, pixels, 4 * 33, &error);
    const int failed = atomic_load(&left) < 0;
    atomic_store(&left, -1);
    const int is_short = failed && atomic_load(&denied) == denied_before;
    if (status != (is_short ? ADCGS_ERR_MEMORY : ADCGS_OK))
        fail_msg("allocation %ld fails: status %d, %s", n, (int)status, error.text);
    assert_int_equal(error.status, status);
    assert_true(!is_short || error.text[0] != 0);
    if (d && failed) /* it continues as if nothing had happened */
        assert_int_equal(adcgs_render(d, &camera, 0, &frame, &error), ADCGS_OK);
    adcgs_close(&d);
    assert_int_equal(atomic_load(&blocks), before);
    return failed;
}

/** Two segments, the second predicted, of several slices. */
static void write_two_segments(adcgs_buffer *bytes)
{
    adcgs_stream stream;
    adcgs_params params;
    uint64_t seed = 2;
    adcgs_random_params(&params, 1, &seed);
    params.k = 2;
    params.n_fg = params.chunks = 2;
    assert_int_equal(adcgs_random_stream(&stream, &params, 2, 130, 4, &seed, NULL), ADCGS_OK);
    stream.slice_log2 = ADCGS_SLICE_LOG2_MIN;
    assert_true(stream.segments[1].predicted); /* with this seed */
    adcgs_buffer_init(bytes);
    assert_int_equal(adcgs_stream_write(&stream, bytes, NULL), ADCGS_OK);
    adcgs_stream_clear(&stream, NULL);
}

static void run_tasks(void *tasks, adcgs_task_fn task, void *work, int n)
{
    in_task = 1;
    for (int i = 0; i < n; i++)
        task(work, i);
    in_task = 0;
    *(int *)tasks += n;
}

/** A caller that lends threads may have an allocator for a single thread only. */
static void test_tasks_allocate_nothing(void **state)
{
    float rgb[33 * 20 * 3];
    adcgs_frame frame = {33, 20, rgb};
    adcgs_buffer bytes;
    adcgs_config config;
    adcgs_decoder *d;
    int tasks = 0;
    (void)state;
    write_two_segments(&bytes);
    adcgs_config_init(&config, sizeof config);
    assert_int_equal(adcgs_pool_wrap(&config.pool, 3, run_tasks, &tasks, NULL), ADCGS_OK);
    assert_int_equal(adcgs_open_memory(&d, bytes.data, bytes.size, &config, NULL), ADCGS_OK);
    assert_true(tasks > 0);
    tasks = 0;
    assert_int_equal(adcgs_render(d, &camera, 0, &frame, NULL), ADCGS_OK);
    assert_true(tasks > 0);
    assert_int_equal(task_calls, 0);
    adcgs_close(&d);
    adcgs_pool_free(&config.pool);
    adcgs_buffer_clear(&bytes);
}

static void test_failing_allocations(void **state)
{
    adcgs_buffer bytes;
    (void)state;
    write_two_segments(&bytes);
    for (int threads = 1; threads <= 2; threads++) {
        long n = 0;
        while (fail_allocation(&bytes, threads, n))
            n++;
        print_message("%d threads: each of %ld allocations failed once\n", threads, n);
        assert_true(n > 100);
    }
    adcgs_buffer_clear(&bytes);
}

/** A pool has as many threads as could be started. */
static void test_no_threads(void **state)
{
    adcgs_pool *pool = NULL;
    (void)state;
    for (int started = 0; started < 3; started++) {
        atomic_store(&left, 2 + started); /* the pool and its list of threads are allocated */
        assert_int_equal(adcgs_pool_create(&pool, 4, NULL), ADCGS_OK);
        atomic_store(&left, -1);
        assert_int_equal(adcgs_pool_threads(pool), 1 + started);
        assert_int_equal(adcgs_pool_missing(pool), 3 - started);
        adcgs_pool_free(&pool);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_failing_allocations),
        cmocka_unit_test(test_tasks_allocate_nothing),
        cmocka_unit_test(test_no_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
