/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The thread pool. One 64-bit ticket holds the number of the current run (high
 * half) and the next unclaimed index (low half). A thread claims an index by
 * compare-and-swap. So a thread that wakes late for a finished run can never
 * claim an index of the next run with the wrong function. The caller works,
 * too, and returns when the number of finished indices reaches n. It does not
 * wait for workers that slept through a short run.
 */
#define _POSIX_C_SOURCE 200809L

#include "base/pool_lent.h"

#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

/* Pause instructions before a thread sleeps: about 20 to 50 microseconds. */
#define SPINS 800
/* Index part of the ticket while no run is open. */
#define CLOSED 0xffffffffu

typedef struct worker {
    adcgs_pool *pool;
    pthread_t id;
    int thread;
} worker;

struct adcgs_pool {
    int threads, started;
    int missing; /* threads that could not be started */
    pthread_mutex_t mutex;
    pthread_cond_t wake, finished;
    int sleepers;     /* workers waiting on wake; under mutex */
    int caller_waits; /* under mutex */
    atomic_int stop;
    atomic_uint_least64_t ticket;
    atomic_int n, done;
    _Atomic(adcgs_work_fn) fn;
    _Atomic(void *) arg;
    worker *workers;       /* [threads - 1] */
    pthread_mutex_t turn;  /* held during a run: several decoders may share the pool */
    adcgs_run_fn lent_run; /* runs tasks on the caller's threads; NULL: the pool's own threads */
    void *lent_user;
};

static void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#else
    atomic_thread_fence(memory_order_seq_cst);
#endif
}

/* Claim and run indices of the open run until none is left. */
static void work(adcgs_pool *pool, int thread)
{
    int completed = 0;
    uint64_t ticket = atomic_load_explicit(&pool->ticket, memory_order_acquire);
    for (;;) {
        const uint32_t index = (uint32_t)ticket;
        const int n = atomic_load_explicit(&pool->n, memory_order_acquire);
        const adcgs_work_fn fn = atomic_load_explicit(&pool->fn, memory_order_acquire);
        void *arg = atomic_load_explicit(&pool->arg, memory_order_acquire);
        if (index >= (uint32_t)n)
            break;
        /* Success proves that the run is still the one whose ticket was read, so n, fn and arg belong to it. */
        if (!atomic_compare_exchange_weak_explicit(&pool->ticket, &ticket, ticket + 1, memory_order_acq_rel,
                                                   memory_order_acquire))
            continue;
        fn(arg, (int)index, thread);
        completed++;
        ticket++;
    }
    if (completed && atomic_fetch_add_explicit(&pool->done, completed, memory_order_acq_rel) + completed ==
                         atomic_load_explicit(&pool->n, memory_order_acquire)) {
        pthread_mutex_lock(&pool->mutex);
        if (pool->caller_waits)
            pthread_cond_signal(&pool->finished);
        pthread_mutex_unlock(&pool->mutex);
    }
}

/* Wait for a run other than seen; returns its number. */
static uint32_t await_run(adcgs_pool *pool, uint32_t seen)
{
    for (int i = 0; i < SPINS; i++) {
        const uint32_t run = (uint32_t)(atomic_load_explicit(&pool->ticket, memory_order_acquire) >> 32);
        if (run != seen || atomic_load_explicit(&pool->stop, memory_order_relaxed))
            return run;
        relax();
    }
    pthread_mutex_lock(&pool->mutex);
    uint32_t run;
    pool->sleepers++;
    while ((run = (uint32_t)(atomic_load_explicit(&pool->ticket, memory_order_acquire) >> 32)) == seen &&
           !atomic_load_explicit(&pool->stop, memory_order_relaxed))
        pthread_cond_wait(&pool->wake, &pool->mutex);
    pool->sleepers--;
    pthread_mutex_unlock(&pool->mutex);
    return run;
}

static void *worker_main(void *arg)
{
    const worker *self = arg;
    adcgs_pool *pool = self->pool;
    uint32_t seen = 0;
    fesetenv(FE_DFL_ENV); /* do not inherit the modes of the thread that made the pool */
    for (;;) {
        seen = await_run(pool, seen);
        if (atomic_load_explicit(&pool->stop, memory_order_acquire))
            return NULL;
        work(pool, self->thread);
    }
}

/* Start as many workers as the system allows. With fewer the work takes longer; the results are the same. */
static void start_workers(adcgs_pool *pool)
{
    for (int i = 0; i < pool->threads - 1; i++) {
        worker *w = &pool->workers[i];
        w->pool = pool;
        w->thread = i + 1;
        if (pthread_create(&w->id, NULL, worker_main, w))
            break;
        pool->started++;
    }
    pool->missing = pool->threads - 1 - pool->started;
    pool->threads -= pool->missing;
}

/* Allocate everything except the threads. */
static adcgs_pool *allocate(int threads, int workers)
{
    adcgs_pool *pool = calloc(1, sizeof *pool);
    if (!pool)
        return NULL;
    pool->workers = calloc((size_t)workers + 1, sizeof *pool->workers);
    if (!pool->workers) {
        free(pool);
        return NULL;
    }
    pool->threads = threads;
    atomic_init(&pool->stop, 0);
    atomic_init(&pool->ticket, CLOSED);
    atomic_init(&pool->n, 0);
    atomic_init(&pool->done, 0);
    atomic_init(&pool->fn, NULL);
    atomic_init(&pool->arg, NULL);
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_mutex_init(&pool->turn, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->finished, NULL);
    return pool;
}

adcgs_status adcgs_pool_create(adcgs_pool **out, int threads, adcgs_error *error)
{
    *out = NULL;
    if (threads < 0 || threads > ADCGS_THREADS_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d threads requested, expected 0..%d", threads, ADCGS_THREADS_MAX);
    if (threads == 0) {
        const long online = sysconf(_SC_NPROCESSORS_ONLN);
        threads = online < 1 ? 1 : online > ADCGS_THREADS_MAX ? ADCGS_THREADS_MAX : (int)online;
    }
    adcgs_pool *pool = allocate(threads, threads);
    if (!pool)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a pool of %d threads", threads);
    start_workers(pool);
    *out = pool;
    return ADCGS_OK;
}

adcgs_status adcgs_pool_wrap(adcgs_pool **out, int threads, adcgs_run_fn run, void *user, adcgs_error *error)
{
    *out = NULL;
    if (threads < 1 || threads > ADCGS_THREADS_MAX || !run)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d threads lent, expected 1..%d and a function that runs tasks on them",
                          threads, ADCGS_THREADS_MAX);
    *out = allocate(threads, 0);
    if (!*out)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a pool of %d threads", threads);
    (*out)->lent_run = run;
    (*out)->lent_user = user;
    return ADCGS_OK;
}

void adcgs_pool_free(adcgs_pool **out)
{
    adcgs_pool *pool = *out;
    *out = NULL;
    if (!pool)
        return;
    pthread_mutex_lock(&pool->mutex);
    atomic_store_explicit(&pool->stop, 1, memory_order_release);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
    for (int i = 0; i < pool->started; i++)
        pthread_join(pool->workers[i].id, NULL);
    pthread_cond_destroy(&pool->finished);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->mutex);
    pthread_mutex_destroy(&pool->turn);
    free(pool->workers);
    free(pool);
}

int adcgs_pool_missing(const adcgs_pool *pool)
{
    return pool ? pool->missing : 0;
}

int adcgs_pool_threads(const adcgs_pool *pool)
{
    return pool ? pool->threads : 1;
}

/* Close the old run before changing its description, then open the new one. */
static void open_run(adcgs_pool *pool, adcgs_work_fn fn, void *arg, int n)
{
    const uint64_t run = (atomic_load_explicit(&pool->ticket, memory_order_relaxed) >> 32) + 1;
    pthread_mutex_lock(&pool->mutex);
    atomic_store_explicit(&pool->ticket, (run - 1) << 32 | CLOSED, memory_order_release);
    atomic_store_explicit(&pool->done, 0, memory_order_release);
    atomic_store_explicit(&pool->fn, fn, memory_order_release);
    atomic_store_explicit(&pool->arg, arg, memory_order_release);
    atomic_store_explicit(&pool->n, n, memory_order_release);
    atomic_store_explicit(&pool->ticket, run << 32, memory_order_release);
    if (pool->sleepers)
        pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->mutex);
}

static void await_done(adcgs_pool *pool, int n)
{
    for (int i = 0; i < SPINS; i++) {
        if (atomic_load_explicit(&pool->done, memory_order_acquire) == n)
            return;
        relax();
    }
    pthread_mutex_lock(&pool->mutex);
    pool->caller_waits = 1;
    while (atomic_load_explicit(&pool->done, memory_order_acquire) != n)
        pthread_cond_wait(&pool->finished, &pool->mutex);
    pool->caller_waits = 0;
    pthread_mutex_unlock(&pool->mutex);
}

void adcgs_pool_run(adcgs_pool *pool, adcgs_work_fn fn, void *arg, int n)
{
    if (!pool || pool->threads == 1 || n <= 1) {
        for (int i = 0; i < n; i++)
            fn(arg, i, 0);
        return;
    }
    pthread_mutex_lock(&pool->turn);
    if (pool->lent_run) {
        run_lent(pool->lent_run, pool->lent_user, pool->threads, fn, arg, n);
    } else {
        open_run(pool, fn, arg, n);
        work(pool, 0);
        await_done(pool, n);
    }
    pthread_mutex_unlock(&pool->turn);
}
