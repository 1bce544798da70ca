/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The moment when the anchors' values become what the stream holds. */
#ifndef ADCGS_TRAIN_FREEZE_H
#define ADCGS_TRAIN_FREEZE_H

#include "train/state.h"

/**
 * Fix the anchors' values as the stream will hold them, by rate and distortion with the configured strength; from here on only
 * networks are trained. What the choice was made from stays in the trainer and its checkpoints, in place of the anchors' Adam
 * moments, which are spent: the values wanted in param[].m, the loss's curvature in param[].v. Without a strength, and without a
 * target to land on, nothing is chosen by it, and the drawing that it takes is spared: param[].v is then 0.
 */
adcgs_status adcgs_freeze(adcgs_trainer *trainer, adcgs_error *error);

#endif
