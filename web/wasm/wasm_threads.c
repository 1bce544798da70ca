/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Threads. Helpers are workers with their own instances over the same memory, and their own stacks in it (helpers.js). They wait
 * for a run of tasks, take some, and wait again. One word, the ticket, holds the number of the run and the number of its tasks
 * that are not taken yet. A task is taken by compare-and-swap, so that a helper that wakes late cannot take a task of the next
 * run for one of this run. The rendering thread takes tasks, too. It needs no helper, and waits for none that has not begun.
 *
 * The C library here does not support threads; the codec's tasks do not call it.
 */
#include "config.h"

#include "wasm/export.h"
#include "wasm/wasm_threads.h"

#include <adcgs/pool.h>

#include <stdatomic.h>
#include <stddef.h>

#define TASKS 0x1ffU /* bits of the ticket; the run's number is above them */

_Static_assert(ADCGS_THREADS_MAX <= TASKS, "the tasks of a run fit into the ticket");

static struct {
    adcgs_pool *pool;
    atomic_uint ticket;
    atomic_uint open; /* tasks that have not finished */
    _Atomic(adcgs_task_fn) task;
    _Atomic(void *) work;
    atomic_int helpers;
} threads;

adcgs_pool *adcgs_page_pool(void)
{
    return threads.pool;
}

/* Sleep until a thread wakes the waiters at a word, provided that it still has this value. */
static void sleep_at(atomic_uint *word, unsigned was)
{
    __builtin_wasm_memory_atomic_wait32((int *)word, (int)was, -1);
}

static void wake(atomic_uint *word, int n)
{
    __builtin_wasm_memory_atomic_notify((int *)word, (unsigned)n);
}

static void take_tasks(void)
{
    unsigned ticket = atomic_load(&threads.ticket);
    while (ticket & TASKS) {
        const adcgs_task_fn task = atomic_load(&threads.task);
        void *const work = atomic_load(&threads.work);
        /* Success proves that the run is the one whose ticket was read: task and work belong to it. */
        if (!atomic_compare_exchange_strong(&threads.ticket, &ticket, ticket - 1))
            continue;
        task(work, (int)(ticket & TASKS) - 1);
        if (atomic_fetch_sub(&threads.open, 1) == 1)
            wake(&threads.open, 1);
        ticket = atomic_load(&threads.ticket);
    }
}

static void run(void *user, adcgs_task_fn task, void *work, int n)
{
    (void)user;
    atomic_store(&threads.task, task);
    atomic_store(&threads.work, work);
    atomic_store(&threads.open, (unsigned)n);
    atomic_store(&threads.ticket, (atomic_load(&threads.ticket) | TASKS) + 1 + (unsigned)n);
    wake(&threads.ticket, n - 1);
    take_tasks();
    for (unsigned open; (open = atomic_load(&threads.open)) != 0;)
        sleep_at(&threads.open, open);
}

/** Before a scene is opened: set the number of threads that render it, if as many helpers start. \return a status. */
int PAGE_EXPORT(page_threads)(int n)
{
    return adcgs_pool_wrap(&threads.pool, n, run, NULL, NULL);
}

/** Main loop of a helper. */
void PAGE_EXPORT(page_help)(void)
{
    atomic_fetch_add(&threads.helpers, 1);
    for (;;) {
        const unsigned ticket = atomic_load(&threads.ticket);
        if (!(ticket & TASKS))
            sleep_at(&threads.ticket, ticket);
        take_tasks();
    }
}

/** Number of helpers that have started. */
int PAGE_EXPORT(page_helpers)(void)
{
    return atomic_load(&threads.helpers);
}
