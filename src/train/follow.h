/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The first anchors of a run that goes on with the segment before: that segment's, as they stand at its end. Who lived a life of
 * its own goes on with it or has died; where bodies and networks moved things to is where they begin.
 */
#ifndef ADCGS_TRAIN_FOLLOW_H
#define ADCGS_TRAIN_FOLLOW_H

#include "fmodel/fmodel.h"
#include "stereo/stereo.h"
#include "train/config.h"

/**
 * The float model that goes on with the model before, which has the times of its part, for a part of this many seconds. found:
 * what matching found in this part, of which bodies get the model's numbers (follow_bodies.h).
 */
adcgs_status adcgs_follow(adcgs_fmodel **out, const adcgs_model *before, const adcgs_train_config *config, adcgs_stereo *found,
                          double duration, adcgs_cpu_level cpu, adcgs_error *error);

#endif
