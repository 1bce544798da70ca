/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A persistent pool of threads for index-parallel work.
 *
 * Results must never depend on which thread ran which index or in what order:
 * callers write to disjoint places per index and merge in index order.
 */
#ifndef ADCGS_BASE_POOL_H
#define ADCGS_BASE_POOL_H

#include "base/base.h"

typedef struct adcgs_pool adcgs_pool;

/** Work on one index; thread in [0, adcgs_pool_threads()) is for scratch space only. */
typedef void (*adcgs_work_fn)(void *arg, int index, int thread);

/** threads >= 1 counts the calling thread; 0: one per online CPU. Workers spin briefly, then sleep. */
adcgs_status adcgs_pool_create(adcgs_pool **out, int threads, adcgs_error *error);
void adcgs_pool_free(adcgs_pool **pool);
/** Number of threads; 1 for NULL. */
int adcgs_pool_threads(const adcgs_pool *pool);
/** Call fn(arg, i, thread) once for each i in [0, n); returns when all are done. pool NULL: serial. Not reentrant. */
void adcgs_pool_run(adcgs_pool *pool, adcgs_work_fn fn, void *arg, int n);

#endif
