/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pruning of anchors by rank, to meet a size. */
#ifndef ADCGS_TRAIN_DENSITY_PRUNE_H
#define ADCGS_TRAIN_DENSITY_PRUNE_H

#include "train/state/state.h"

/** Keeps the `keep` anchors (at least one) that covered the most pixels since the last change of the anchors. */
adcgs_status adcgs_prune_anchors(adcgs_trainer *trainer, uint32_t keep, adcgs_error *error);

#endif
