/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Validation of checkpoints, so that no later stage reads or writes outside its arrays. */
#ifndef ADCGS_TRAIN_STATE_CHECKPOINT_CHECK_H
#define ADCGS_TRAIN_STATE_CHECKPOINT_CHECK_H

#include "train/state/state.h"

/** Checks the positions of anchors: within the grid, and in Morton order. Returns NULL or the error. */
const char *adcgs_checkpoint_check_places(const adcgs_fmodel *f, const uint32_t (*pos)[3], uint32_t n);

/** Checks everything else that later stages rely on. Returns NULL or the error. */
const char *adcgs_checkpoint_check(const adcgs_trainer *trainer);

#endif
