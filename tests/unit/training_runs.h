/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training runs over the tiny scene: through all stages, to their end or to an iteration, and comparisons of their states.
 */
#ifndef ADCGS_TESTS_TRAINING_RUNS_H
#define ADCGS_TESTS_TRAINING_RUNS_H

#include "tiny_scene.h"

#include <math.h>

static inline adcgs_train_config all_stages_config(void)
{
    adcgs_train_config c = small_config();
    c.freeze_start = 0.92f; /* long enough to stop in */
    c.params.adaptive_steps = 1;
    c.params.spans = 1;
    return c;
}

static inline void run(adcgs_trainer *t, adcgs_train_observe observe, void *user)
{
    const int stopped = run_trainer(t, observe, user);
    assert_int_equal(stopped, t->run.iteration < t->config.iterations && !(t->config.time_limit > 0));
}

static inline void assert_same(const adcgs_buffer *a, const adcgs_buffer *b)
{
    assert_int_equal(a->size, b->size);
    assert_memory_equal(a->data, b->data, a->size);
}

static inline int all_finite(const adcgs_fmodel *f)
{
    for (int i = 0; i < ADCGS_P_COUNT; i++)
        for (size_t j = 0; j < f->param[i].n; j++)
            if (!isfinite(f->param[i].p[j]))
                return 0;
    return 1;
}

#endif
