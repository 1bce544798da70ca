/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The pool where no threads can be started, in place of pool.c: on WebAssembly. One that is created has the caller's thread
 * alone; those that a caller lends are used.
 */
#include "base/pool_lent.h"

#include <stdlib.h>

struct adcgs_pool {
    int threads;
    adcgs_run_fn run; /* NULL: nobody's but the caller's */
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
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d threads asked for; 0 to %d are possible", threads, ADCGS_THREADS_MAX);
    return create(out, (adcgs_pool){ .threads = 1 }, error);
}

adcgs_status adcgs_pool_wrap(adcgs_pool **out, int threads, adcgs_run_fn run, void *user, adcgs_error *error)
{
    *out = NULL;
    if (threads < 1 || threads > ADCGS_THREADS_MAX || !run)
        return adcgs_fail(error, ADCGS_ERR_USAGE, "%d threads lent; 1 to %d are possible, and a function that runs tasks on them",
                          threads, ADCGS_THREADS_MAX);
    return create(out, (adcgs_pool){ threads, run, user }, error);
}

void adcgs_pool_free(adcgs_pool **pool)
{
    free(*pool);
    *pool = NULL;
}

int adcgs_pool_missing(const adcgs_pool *pool)
{
    (void)pool;
    return 0; /* that there are none is no surprise here */
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
