/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Storing and restoring the progress of a run. */
#include "config.h"

#include "train/state/run_state.h"

void adcgs_run_state_walk(adcgs_checkpoint_walk *w, adcgs_run_state *s)
{
    adcgs_checkpoint_visit(w, &s->iteration, sizeof s->iteration);
    adcgs_checkpoint_visit(w, &s->lr_scale, sizeof s->lr_scale);
    adcgs_checkpoint_visit(w, &s->rollbacks, sizeof s->rollbacks);
    adcgs_checkpoint_visit(w, &s->mean_loss, sizeof s->mean_loss);
    adcgs_checkpoint_visit(w, &s->mean_mse, sizeof s->mean_mse);
    adcgs_checkpoint_visit(w, &s->least_mse, sizeof s->least_mse);
    adcgs_checkpoint_visit(w, &s->elapsed, sizeof s->elapsed);
}

void adcgs_run_state_clear(adcgs_run_state *s)
{
    adcgs_buffer_clear(&s->snapshot);
}
