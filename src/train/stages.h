/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The stages of a run in their order: this room's stages are called from here and from nowhere else. */
#ifndef ADCGS_TRAIN_STAGES_H
#define ADCGS_TRAIN_STAGES_H

#include "train/state.h"

/** What is due before an iteration at this progress: pictures of another size, more of time, growth, stages, rate control. */
adcgs_status adcgs_stages_before(adcgs_trainer *trainer, double progress, adcgs_error *error);
/** What is due of all stages that are still to come, with no iteration between them and no way back. */
adcgs_status adcgs_stages_skip(adcgs_trainer *trainer, adcgs_error *error);
/** What is due at the end. */
adcgs_status adcgs_stages_finish(adcgs_trainer *trainer, adcgs_error *error);
/** What the size of pictures is divided by at a progress (coarse to fine). */
int adcgs_stages_divide(const adcgs_trainer *trainer, double progress);

#endif
