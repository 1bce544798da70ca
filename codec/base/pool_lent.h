/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Work on threads that a caller lends (adcgs_pool_wrap()). Each thread gets a task, which takes indices until none is left. So it
 * does not matter how many tasks really run at once.
 */
#ifndef ADCGS_BASE_POOL_LENT_H
#define ADCGS_BASE_POOL_LENT_H

#include "base/thread_pool.h"

#include <fenv.h>
#include <stdatomic.h>

typedef struct lent_work {
    adcgs_work_fn fn;
    void *arg;
    int n;
    atomic_int next;
} lent_work;

/* Take indices of a run until none is left. The thread may be in any floating-point mode; its mode is restored. */
static void lent_task(void *work, int task)
{
    lent_work *w = work;
    fenv_t modes;
    fegetenv(&modes);
    fesetenv(FE_DFL_ENV);
    for (int i; (i = atomic_fetch_add_explicit(&w->next, 1, memory_order_relaxed)) < w->n;)
        w->fn(w->arg, i, task);
    fesetenv(&modes);
}

static void run_lent(adcgs_run_fn run, void *user, int threads, adcgs_work_fn fn, void *arg, int n)
{
    lent_work w = {.fn = fn, .arg = arg, .n = n};
    atomic_init(&w.next, 0);
    run(user, lent_task, &w, ADCGS_MIN(threads, n));
}

#endif
