/* SPDX-License-Identifier: BSD-2-Clause */
/** \file State of rate control, and what it asks of the room that builds streams. */
#ifndef ADCGS_TRAIN_RATE_STATE_H
#define ADCGS_TRAIN_RATE_STATE_H

#include <adcgs/types.h>

struct adcgs_trainer;

/** Exact bytes of the stream that a run would end with now, provided by the room that builds streams. */
typedef adcgs_status (*adcgs_train_measure)(void *user, const struct adcgs_trainer *trainer, adcgs_bytes *bytes,
                                            adcgs_error *error);

/** State of the control; a checkpoint carries it. */
typedef struct adcgs_rate_control {
    double error;    /**< at the last step: log of bytes over room, or so much of the dB over the target; > 0 raises lambda */
    double at;       /**< progress of the last step; 0: none yet */
    double measured; /**< progress of the last measurement; 0: none yet */
    double fixed;    /**< bytes beside the features */
    double ratio;    /**< bytes of features as written over those estimated */
    double psnr;     /**< dB that training views will have, about */
    double tried, off; /**< lambda of the last try, and its error as above */
    double early;    /**< that of this try, shortly before it is judged */
    uint32_t tries, looked; /**< tries that are over; whether the bytes of this one were looked at */
    uint64_t missed; /**< whether a run fell short of a quality in the end, and was begun again; so wide that there is no gap */
} adcgs_rate_control;

#endif
