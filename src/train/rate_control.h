/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Steering a run to a size or to a quality. Before it, a size decides how many
 * anchors and how wide networks it can hold. From the moment that rate counts,
 * lambda follows the bytes that a stream would take, or the PSNR of training
 * views. When values are frozen, and once more at the end, the strength of the
 * choice of levels is sought at which the target is met exactly.
 * Only training views are looked at.
 */
#ifndef ADCGS_TRAIN_RATE_CONTROL_H
#define ADCGS_TRAIN_RATE_CONTROL_H

#include "train/schedule.h"

#include <adcgs/decoder.h>

struct adcgs_trainer;

/** Bits that a weight takes in a stream, about. */
#define ADCGS_WEIGHT_BITS 7

/** Exact bytes of the stream that a run would end with now, provided by the room that builds streams. */
typedef adcgs_status (*adcgs_train_measure)(void *user, const struct adcgs_trainer *trainer, adcgs_bytes *bytes,
                                            adcgs_error *error);

/** State of the control; a checkpoint carries it. */
typedef struct adcgs_control {
    double error;    /**< at the last step: log of bytes over room, or so much of the dB over the target; > 0 raises lambda */
    double at;       /**< progress of the last step; 0: none yet */
    double measured; /**< progress of the last measurement; 0: none yet */
    double fixed;    /**< bytes beside the features */
    double ratio;    /**< bytes of features as written over those estimated */
    double psnr;     /**< dB, of a sample of training views */
} adcgs_control;

/**
 * Fit the budget of anchors and the widths of the networks into a size, unless they were chosen by hand. ADCGS_ERR_USAGE if not
 * even the smallest networks and a few anchors fit.
 */
adcgs_status adcgs_control_plan(adcgs_train_config *config, adcgs_error *error);

/** Called before each iteration, while anchors are trained: measures now and then, moves lambda. */
adcgs_status adcgs_control_step(struct adcgs_trainer *trainer, double progress, adcgs_error *error);

/**
 * Mean PSNR of up to `most` training views in full size, spread evenly, as a player shows them; before values are frozen, with
 * the errors that quantisation makes or will make. Quick where views are loaded in full size.
 */
adcgs_status adcgs_control_psnr(struct adcgs_trainer *trainer, uint32_t most, double *psnr, adcgs_error *error);

/** Called when values have just been frozen: meets the target less what training the networks will change. */
adcgs_status adcgs_control_frozen(struct adcgs_trainer *trainer, adcgs_error *error);
/** Called at the end: meets the target if it is not met, as far as that can be. */
adcgs_status adcgs_control_finish(struct adcgs_trainer *trainer, adcgs_error *error);

#endif
