/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Runs that stop before an iteration, and networks with random weights. */
#ifndef ADCGS_TESTS_WEIGHT_RUNS_H
#define ADCGS_TESTS_WEIGHT_RUNS_H

#include "tiny_scene.h"

#include "grad/random.h"

static inline void go_on(adcgs_trainer *t, uint32_t stop)
{
    run_trainer(t, stop_at, &stop);
}

/** A run that stopped before iteration `stop`. */
static inline adcgs_trainer *run_to(const adcgs_train_config *config, uint32_t stop)
{
    adcgs_trainer *t = make_trainer(config, pool);
    go_on(t, stop);
    return t;
}

/* ---- The rate of weights ---- */

static inline void randomise(adcgs_fmodel *f, int group, double size)
{
    for (size_t i = 0; i < f->param[group].n; i++) {
        const double wide = i % 3 == 0 ? 0.02 : 1; /* some next to 0, where magnitudes are rounded off */
        f->param[group].p[i] = (float)(size * wide * adcgs_random_normal(5, (uint64_t)group, i));
    }
}

#endif
