/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training: one loop over posed images. The same seed gives the same model for any number of threads and any level of vector
 * kernels; scalar kernels round differently and give another model. A run can stop, and continue exactly from there.
 */
#ifndef ADCGS_TRAIN_TRAINER_H
#define ADCGS_TRAIN_TRAINER_H

#include "train/state/checkpoint.h"
#include "train/state/state.h"

/** Report to an observer. Bits are estimates until the stream is written. */
typedef struct adcgs_train_report {
    const char *stage;
    uint32_t iteration, iterations;
    uint32_t anchors;
    int divide;                  /**< factor of image reduction in use; at the start, the next one */
    double loss, psnr;           /**< running means over training views; none at iteration 0 */
    double bytes;                /**< estimated bytes of the features; 0 before rate is measured */
    double stream[ADCGS_GROUPS]; /**< the same for eta, f_v, Sigma_v, C_v (layer 0 without its flags) and the chunks of f_g */
    double lambda;
    adcgs_time spent; /**< since the start */
    double rate;      /**< recent iterations per second */
    double left;      /**< estimated seconds; NaN before the first iteration */
    int rollbacks;
    int attempt; /**< try of the rate search, from 1; 0 outside the search */
} adcgs_train_report;

/** Called often; returns nonzero to stop training (a checkpoint can then be saved). */
typedef int (*adcgs_train_observe)(void *user, const adcgs_train_report *report);

/** True if training views are rendered so badly that one colour for all would be much better: something went wrong. */
int adcgs_trainer_is_lost(const adcgs_trainer *trainer);

/** True if the run is past the stage that trains its model without motion; always true for a run without motion. */
int adcgs_trainer_moves(const adcgs_trainer *trainer);

/** Trains to the end, or (*stopped = 1) until observe returns nonzero or before the first iteration that lambda affects. */
adcgs_status adcgs_trainer_run(adcgs_trainer *trainer, adcgs_train_observe observe, void *user, int *stopped, adcgs_error *error);

/**
 * Finishes a loaded or stopped run without further iterations: applies the steps of the end that are possible now. ADCGS_ERR_DATA
 * before the first iteration.
 */
adcgs_status adcgs_trainer_finish(adcgs_trainer *trainer, adcgs_train_report *report, adcgs_error *error);

#endif
