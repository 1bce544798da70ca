/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Unfreezing of anchors in a run that continues the previous segment. An anchor is trained again if its part of the image has
 * changed, in brightness or because the model does not follow its motion. Unfrozen anchors are sent again.
 */
#ifndef ADCGS_TRAIN_DENSITY_UNFREEZE_H
#define ADCGS_TRAIN_DENSITY_UNFREEZE_H

#include "train/state/state.h"

/** Unfreezes anchors at fixed times of a run. If nothing needs training, the run ends: its iteration becomes the last. */
adcgs_status adcgs_unfreeze_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
