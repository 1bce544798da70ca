/* SPDX-License-Identifier: BSD-2-Clause */
/** \file State of rate control, and its interface to the code that builds streams. */
#ifndef ADCGS_TRAIN_RATE_RATE_STATE_H
#define ADCGS_TRAIN_RATE_RATE_STATE_H

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

#endif
