/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A persistent pool of threads for index-parallel work. Workers spin briefly, then sleep.
 *
 * Results must never depend on the thread that runs an index or on the order:
 * callers write to disjoint places per index and merge in index order.
 */
#ifndef ADCGS_BASE_THREAD_POOL_H
#define ADCGS_BASE_THREAD_POOL_H

#include "base/base.h"

#include <adcgs/pool.h>

/** Number of requested threads that could not be started. */
int adcgs_pool_missing(const adcgs_pool *pool);

/** Work on one index; thread in [0, adcgs_pool_threads()) is for scratch space only. */
typedef void (*adcgs_work_fn)(void *arg, int index, int thread);

/**
 * Call fn(arg, i, thread) once for each i in [0, n); returns when all calls are done. pool NULL: serial. Runs of several callers
 * follow one another; fn must not run anything in the same pool.
 */
void adcgs_pool_run(adcgs_pool *pool, adcgs_work_fn fn, void *arg, int n);

#endif
