/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The first anchors of a run that continues the previous segment: that segment's anchors, in their state at its end. Lifetimes
 * continue or have ended. Bodies and networks start from the deformation at the end.
 */
#ifndef ADCGS_TRAIN_CONTINUE_SEGMENT_H
#define ADCGS_TRAIN_CONTINUE_SEGMENT_H

#include "fmodel/fmodel.h"
#include "init/stereo.h"
#include "train/train_config.h"

/**
 * Creates the float model that continues `before` for `duration` seconds. before: the model with the times of its segment. found:
 * the result of matching in this segment; its bodies get the model's numbers (continue_bodies.h).
 */
adcgs_status adcgs_continue_segment(adcgs_fmodel **out, const adcgs_model *before, const adcgs_train_config *config,
                                    adcgs_stereo *found, double duration, adcgs_cpu_level cpu, adcgs_error *error);

#endif
