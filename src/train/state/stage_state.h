/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The single steps of a run that have taken place (train/stage_table.h). Owned by stages.c; in checkpoints. */
#ifndef ADCGS_TRAIN_STATE_STAGE_STATE_H
#define ADCGS_TRAIN_STATE_STAGE_STATE_H

#include "train/state/visit.h"

#include <stdint.h>

/** Zero-initialise. */
typedef struct adcgs_stage_state {
    uint8_t fixed_unchanging, motion_tested;
    uint8_t units_pruned; /**< number of prunings of hidden units, 0 to 2 */
    uint8_t pruned, tiered, rounding, frozen;
    uint8_t unfreeze_tests; /**< number of times that anchors were tested for unfreezing */
} adcgs_stage_state;

/** Stores or restores all members but rounding, which the checkpoint has before the settings that depend on it. */
void adcgs_stage_state_walk(adcgs_checkpoint_walk *walk, adcgs_stage_state *state);

#endif
