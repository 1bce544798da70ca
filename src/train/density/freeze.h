/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Freezing of the anchors' values to those that the stream will hold. */
#ifndef ADCGS_TRAIN_DENSITY_FREEZE_H
#define ADCGS_TRAIN_DENSITY_FREEZE_H

#include "train/state/state.h"

/**
 * Fixes the anchors' values as the stream will hold them, by rate and distortion with the configured strength. From here on only
 * networks are trained. The input of the choice replaces the anchors' Adam moments, which are no longer needed, in the trainer
 * and its checkpoints. param[].m: the unquantised values; param[].v: the curvature of the loss. Without a strength and without a
 * target, the curvature is not needed; its renders are skipped, and param[].v is 0.
 */
adcgs_status adcgs_freeze(adcgs_trainer *trainer, adcgs_error *error);

#endif
