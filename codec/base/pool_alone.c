/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The pool for platforms that cannot start threads (WebAssembly), in place of thread_pool.c. A pool from adcgs_pool_create() has
 * the caller's thread alone. Lent threads (adcgs_pool_wrap()) are used.
 */
#include "base/pool_lent.h"

#include <stdlib.h>

struct adcgs_pool {
    int threads;
    adcgs_run_fn run; /* NULL: only the calling thread */
    void *user;
};

static adcgs_status create(adcgs_pool **out, adcgs_pool pool, adcgs_error *error)
{
    *out = calloc(1, sizeof **out);
    if (!*out)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for a pool of %d threads", pool.threads);
    **out = pool;
    return ADCGS_OK;
}

adcgs_status adcgs_pool_create(adcgs_pool **out, int threads, adcgs_error *error)
{
    *out = NULL;
    if (threads < 0 || threads > ADCGS_THREADS_MAX)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d threads requested, expected 0..%d", threads, ADCGS_THREADS_MAX);
    return create(out, (adcgs_pool){.threads = 1}, error);
}

adcgs_status adcgs_pool_wrap(adcgs_pool **out, int threads, adcgs_run_fn run, void *user, adcgs_error *error)
{
    *out = NULL;
    if (threads < 1 || threads > ADCGS_THREADS_MAX || !run)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d threads lent, expected 1..%d and a function that runs tasks on them",
                          threads, ADCGS_THREADS_MAX);
    return create(out, (adcgs_pool){threads, run, user}, error);
}

void adcgs_pool_free(adcgs_pool **pool)
{
    free(*pool);
    *pool = NULL;
}

int adcgs_pool_missing(const adcgs_pool *pool)
{
    (void)pool;
    return 0; /* missing threads are expected here */
}

int adcgs_pool_threads(const adcgs_pool *pool)
{
    return pool ? pool->threads : 1;
}

void adcgs_pool_run(adcgs_pool *pool, adcgs_work_fn fn, void *arg, int n)
{
    if (pool && pool->threads > 1 && n > 1) {
        run_lent(pool->run, pool->user, pool->threads, fn, arg, n);
        return;
    }
    for (int i = 0; i < n; i++)
        fn(arg, i, 0);
}
