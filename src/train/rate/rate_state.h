/* SPDX-License-Identifier: BSD-2-Clause */
/** \file State of rate control, and its interface to the code that builds streams. */
#ifndef ADCGS_TRAIN_RATE_RATE_STATE_H
#define ADCGS_TRAIN_RATE_RATE_STATE_H

#include "fmodel/fmodel.h"
#include "train/state/visit.h"

#include <adcgs/types.h>

struct adcgs_trainer;

/** Exact bytes of the stream that a run would write now, provided by the code that builds streams. */
typedef adcgs_status (*adcgs_train_measure)(void *user, const struct adcgs_trainer *trainer, adcgs_bytes *bytes,
                                            adcgs_error *error);

/** State of the controller; part of checkpoints. */
typedef struct adcgs_rate_control {
    double error;    /**< at the last step: log of bytes over room, or a multiple of the dB above the target; > 0 raises lambda */
    double at;       /**< progress of the last step; 0: none yet */
    double measured; /**< progress of the last measurement; 0: none yet */
    double fixed;    /**< bytes except the features */
    double ratio;    /**< written over estimated bytes of the features */
    double psnr;     /**< predicted dB of the training views */
    double tried, off;      /**< lambda of the last try, and its error as above */
    double early;           /**< error of the current try at its first measurement */
    uint32_t tries, looked; /**< finished tries; 1: the current try had its first measurement */
    uint64_t missed;        /**< 1: the run missed a quality at the end and was restarted; 64 bits avoid padding */
} adcgs_rate_control;

/** State of the rate in the loss; owned by the files of this folder. Zero-initialise. */
typedef struct adcgs_rate_state {
    /* In checkpoints. */
    uint8_t lambda_used; /**< 1: lambda has affected the run and must not change */
    double contrast;     /**< of the initial training images; 0: unknown */
    double lambda;       /**< the configuration's, scaled by contrast or controlled by a target */
    adcgs_rate_control control;
    double mean_bits[ADCGS_GROUPS];
    adcgs_buffer begin; /**< state at rate_start, while the run may return; see rate_search.h */
    /* Not in checkpoints. */
    double next_lambda;          /**< > 0: the loop returns to rate_start with this lambda; see rate_search.h */
    int until_lambda;            /**< 1: stop before the first iteration that lambda affects */
    adcgs_train_measure measure; /**< provided by the code that builds streams; used if there is a target size */
    void *measure_user;
} adcgs_rate_state;

/** Stores or restores the members in checkpoints but lambda_used, which stands before the settings, and begin. */
void adcgs_rate_state_walk(adcgs_checkpoint_walk *walk, adcgs_rate_state *state);
/** Stores or restores begin, which is itself a checkpoint without such a state. */
void adcgs_rate_state_walk_begin(adcgs_checkpoint_walk *walk, adcgs_rate_state *state);
void adcgs_rate_state_clear(adcgs_rate_state *state);

#endif
