/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Threads for decoders. Without a pool in its adcgs_config a decoder starts threads of its own. A program with many decoders can
 * give them one pool, which they use in turn. A program with threads of its own can lend these.
 *
 * The results of a decoder never depend on the threads, their number, or their floating-point modes.
 */
#ifndef ADCGS_POOL_H
#define ADCGS_POOL_H

#include <adcgs/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A task for a caller's threads. It neither allocates nor frees memory. */
typedef void (*adcgs_task_fn)(void *work, int task);

/**
 * Calls task(work, i) once for each i in [0, n), on any threads, in any order, in sequence or concurrently. Returns when all
 * calls have returned. n is at most the pool's number of threads.
 */
typedef void (*adcgs_run_fn)(void *user, adcgs_task_fn task, void *work, int n);

/**
 * Start a pool of threads. It has fewer threads than requested if the system allows fewer: adcgs_pool_threads() gives the number.
 * \param out receives the pool, to be freed with adcgs_pool_free(); NULL on failure
 * \param threads 1..ADCGS_THREADS_MAX, including the thread that calls a decoder; 0: one for each processor
 * \param error says why it failed; may be NULL
 * \return ADCGS_OK, ADCGS_ERR_USAGE or ADCGS_ERR_MEMORY
 */
ADCGS_API adcgs_status adcgs_pool_create(adcgs_pool **out, int threads, adcgs_error *error);

/**
 * Make a pool of the caller's threads. The function starts none.
 * \param out receives the pool, to be freed with adcgs_pool_free(); NULL on failure
 * \param threads tasks that can run at once, 1..ADCGS_THREADS_MAX
 * \param run distributes tasks; called in the thread that calls a decoder, never concurrently for one pool
 * \param user passed to run
 * \param error says why it failed; may be NULL
 * \return ADCGS_OK, ADCGS_ERR_USAGE or ADCGS_ERR_MEMORY
 */
ADCGS_API adcgs_status adcgs_pool_wrap(adcgs_pool **out, int threads, adcgs_run_fn run, void *user, adcgs_error *error);

/**
 * Free a pool and end the threads that it started. All decoders that use it must be closed before.
 * \param pool is set to NULL; may point to NULL
 */
ADCGS_API void adcgs_pool_free(adcgs_pool **pool);

/**
 * Number of threads.
 * \param pool may be NULL
 * \return at least 1; 1 for NULL
 */
ADCGS_API int adcgs_pool_threads(const adcgs_pool *pool);

#ifdef __cplusplus
}
#endif
#endif
