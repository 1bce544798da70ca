/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Progress of a run: its iterations, running means, times, and the snapshot for rollbacks. Owned by trainer.c. */
#ifndef ADCGS_TRAIN_STATE_RUN_STATE_H
#define ADCGS_TRAIN_STATE_RUN_STATE_H

#include "train/state/visit.h"
#include "train/time_left.h"

/** Zero-initialise, with lr_scale 1. */
typedef struct adcgs_run_state {
    /* In checkpoints. */
    uint32_t iteration;
    float lr_scale; /**< factor of the step sizes; a rollback halves it */
    uint32_t rollbacks;
    double mean_loss, mean_mse;
    double least_mse;   /**< minimum of mean_mse; 0 before the first iteration */
    adcgs_time elapsed; /**< of all programs that took part in the run */
    /* Not in checkpoints. */
    int diverged;       /**< the run ended after too many rollbacks */
    adcgs_time started; /**< start of this program's time; clock 0: when the run begins or continues */
    adcgs_time_left left;
    adcgs_buffer snapshot;
    uint32_t snapshot_at; /**< its iteration */
    int torn;             /**< 1: the state is between two steps of a change; only the snapshot is consistent */
} adcgs_run_state;

/** Stores or restores the members in checkpoints. */
void adcgs_run_state_walk(adcgs_checkpoint_walk *walk, adcgs_run_state *state);
void adcgs_run_state_clear(adcgs_run_state *state);

#endif
