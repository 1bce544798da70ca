/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * One walk over the state of a run visits every number that the rest of the run depends on. Storing and restoring are its
 * visitors.
 */
#ifndef ADCGS_TRAIN_STATE_CHECKPOINT_WALK_H
#define ADCGS_TRAIN_STATE_CHECKPOINT_WALK_H

#include "train/state/checkpoint.h"
#include "train/state/visit.h"

/** Format number; the first number that the walk visits, as 64 bits; definition, one more with each change. */
enum { ADCGS_CHECKPOINT_FORMAT = 36 };

/** Stores the whole state. */
void adcgs_checkpoint_walk_all(adcgs_checkpoint_walk *w, const adcgs_trainer *trainer);

#endif
