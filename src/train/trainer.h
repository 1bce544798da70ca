/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Training: one loop over posed pictures. The same seed gives the same model at
 * any thread count, by vector kernels of any level; scalar ones round otherwise
 * and give another. A run can stop, and continue exactly from there.
 */
#ifndef ADCGS_TRAIN_TRAINER_H
#define ADCGS_TRAIN_TRAINER_H

#include "train/checkpoint.h"
#include "train/state.h"

/** What an observer is told. Bits are estimates until the stream is written. */
typedef struct adcgs_train_report {
    const char *stage;
    uint32_t iteration, iterations;
    uint32_t anchors;
    int divide;             /**< resolution in use, at the start the one to come: images are divided by this */
    double loss, psnr;      /**< running means over training views; none at iteration 0 */
    double bytes;           /**< estimated bytes of the features; 0 before rate is measured */
    double stream[ADCGS_GROUPS]; /**< the same of eta, f_v, Sigma_v, C_v (layer 0, but for its flags) and the chunks of f_g */
    double lambda;
    adcgs_time spent;       /**< since the start */
    double rate;            /**< iterations per second lately */
    double left;            /**< seconds, estimated; not a number before an iteration has been seen */
    int rollbacks;
    int attempt;            /**< at the lambda of a size or a quality, while that is sought: from 1 on; else 0 */
} adcgs_train_report;

/** Called often; return nonzero to stop training (a checkpoint can then be saved). */
typedef int (*adcgs_train_observe)(void *user, const adcgs_train_report *report);

/** Whether training views are drawn so badly that one colour for all of them would be much better: something went wrong. */
int adcgs_trainer_is_lost(const adcgs_trainer *trainer);

/** Whether the run is past the stage in which its model is trained without motion; one without motion always is. */
int adcgs_trainer_moves(const adcgs_trainer *trainer);

/** Train to the end, or (*stopped = 1) until observe says stop or lambda would have a say. */
adcgs_status adcgs_trainer_run(adcgs_trainer *trainer, adcgs_train_observe observe, void *user, int *stopped, adcgs_error *error);

/**
 * Be done with a run that has been loaded or stopped, without an iteration more: what its end would have done that can be done
 * now is. ADCGS_ERR_DATA before the first iteration.
 */
adcgs_status adcgs_trainer_finish(adcgs_trainer *trainer, adcgs_train_report *report, adcgs_error *error);

#endif
