/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Storing and restoring the steps that have taken place. */
#include "config.h"

#include "train/state/stage_state.h"

void adcgs_stage_state_walk(adcgs_checkpoint_walk *w, adcgs_stage_state *s)
{
    adcgs_checkpoint_visit(w, &s->fixed_unchanging, sizeof s->fixed_unchanging);
    adcgs_checkpoint_visit(w, &s->motion_tested, sizeof s->motion_tested);
    adcgs_checkpoint_visit(w, &s->units_pruned, sizeof s->units_pruned);
    adcgs_checkpoint_visit(w, &s->pruned, sizeof s->pruned);
    adcgs_checkpoint_visit(w, &s->tiered, sizeof s->tiered);
    adcgs_checkpoint_visit(w, &s->frozen, sizeof s->frozen);
    adcgs_checkpoint_visit(w, &s->unfreeze_tests, sizeof s->unfreeze_tests);
}
