/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Requests of several threads to one source of splats over time. */
#ifndef ADCGS_TESTS_MEDIA_DYNAMIC_THREADS_H
#define ADCGS_TESTS_MEDIA_DYNAMIC_THREADS_H

#include "dynamic_fixture.h"

#include <pthread.h>

enum { THREADS = 8, TIMES = 20 }; /* more threads than a reader keeps decoded parts */

typedef struct thread_job {
    const adcgs_dynamic *dynamic;
    uint32_t first;
    float sum[TIMES];
    int failed;
} thread_job;

/** Sums of positions at times in an order of its own. */
static inline void *run_job(void *argument)
{
    thread_job *const j = argument;
    for (uint32_t k = 0; k < TIMES; k++) {
        const uint32_t i = (j->first + k * 7) % TIMES;
        adcgs_splats s;
        if (adcgs_dynamic_at(j->dynamic, i * adcgs_dynamic_duration(j->dynamic) / TIMES, &s, NULL) != ADCGS_OK) {
            j->failed = 1;
            continue;
        }
        for (uint32_t n = 0; n < s.n; n++)
            j->sum[i] += s.mean[0][n] * s.opacity[n];
        adcgs_splats_free(&s);
    }
    return NULL;
}

/** All threads get the same splats. */
static inline void expect_threads(const adcgs_dynamic *dynamic)
{
    static thread_job jobs[THREADS];
    pthread_t threads[THREADS];
    for (uint32_t i = 0; i < THREADS; i++) {
        jobs[i] = (thread_job){.dynamic = dynamic, .first = 3 * i};
        assert_int_equal(pthread_create(&threads[i], NULL, run_job, &jobs[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
        assert_false(jobs[i].failed);
        assert_memory_equal(jobs[i].sum, jobs[0].sum, sizeof jobs[0].sum);
    }
}

#endif
