/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Threads: helpers are workers with instances of their own over the same memory, and a stack of their own in it (helpers.js).
 * They wait for a run of tasks, take some, and wait again. One word, the ticket, has the number of the run and how many of its
 * tasks nobody has taken yet: a task is taken by compare-and-swap, so that a helper that wakes late cannot take one of the next
 * run for one of this. The thread that draws takes tasks as well: it needs no helper, and waits for none that has not begun.
 *
 * The C library here knows no threads; the codec's tasks ask nothing of it.
 */
#include "config.h"

#include "wasm/export.h"
#include "wasm/threads.h"

#include <adcgs/pool.h>

#include <stdatomic.h>
#include <stddef.h>

#define TASKS 0x1ffU /* of the ticket; above them stands the run's number */

_Static_assert(ADCGS_THREADS_MAX <= TASKS, "the tasks of a run fit into the ticket");

static struct {
    adcgs_pool *pool;
    atomic_uint ticket;
    atomic_uint open; /* tasks that have not come to their end */
    _Atomic(adcgs_task_fn) task;
    _Atomic(void *) work;
    atomic_int helpers;
} threads;

adcgs_pool *adcgs_page_pool(void)
{
    return threads.pool;
}

/* Sleep until someone wakes those that wait at a word, if it still is what it was. */
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
        /* Success proves that the run is the one whose ticket was read: task and work are its. */
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

/** Before a scene is opened: how many threads draw it, if as many helpers come. \return a status. */
int PAGE_EXPORT(page_threads)(int n)
{
    return adcgs_pool_wrap(&threads.pool, n, run, NULL, NULL);
}

/** A helper's life. */
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

/** How many have come. */
int PAGE_EXPORT(page_helpers)(void)
{
    return atomic_load(&threads.helpers);
}
