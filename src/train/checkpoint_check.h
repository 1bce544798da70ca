/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Whether what a checkpoint holds is the state of a run, so that nothing reaches beyond its arrays later. */
#ifndef ADCGS_TRAIN_CHECKPOINT_CHECK_H
#define ADCGS_TRAIN_CHECKPOINT_CHECK_H

#include "train/state.h"

/** Places of anchors: within the grid, and in Morton order. NULL, or what is wrong. */
const char *adcgs_checkpoint_check_places(const adcgs_fmodel *f, const uint32_t (*pos)[3], uint32_t n);

/** Everything else that later stages rely on. NULL, or what is wrong. */
const char *adcgs_checkpoint_check(const adcgs_trainer *trainer);

#endif
