/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The order of a run's stages. All stages of src/train are called from here only. */
#ifndef ADCGS_TRAIN_STAGES_H
#define ADCGS_TRAIN_STAGES_H

#include "train/state/state.h"

/** Called before an iteration at this progress: image size, curriculum, growth, stages, rate control. */
adcgs_status adcgs_stages_before(adcgs_trainer *trainer, double progress, adcgs_error *error);
/** Runs all remaining stages without iterations between them and without a return to earlier states. */
adcgs_status adcgs_stages_skip(adcgs_trainer *trainer, adcgs_error *error);
/** Called at the end of a run. */
adcgs_status adcgs_stages_finish(adcgs_trainer *trainer, adcgs_error *error);
/** Factor of image reduction at a progress (coarse to fine). */
int adcgs_stages_divide(const adcgs_trainer *trainer, double progress);

#endif
