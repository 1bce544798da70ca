/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The views of an iteration: as many looks as the configuration says, and the mean of their gradients. Runs of a team look at
 * some of them each, and know all of it then.
 */
#ifndef ADCGS_TRAIN_BATCH_H
#define ADCGS_TRAIN_BATCH_H

#include "train/state.h"

/**
 * Look at an iteration's views: f->param[].g is the mean of their gradients, stats have what they show of primitives, and
 * trainer->batch.seen what else there is to say of each. Gradients and statistics are summed by a tree over the views
 * (tree_sum.h).
 */
adcgs_status adcgs_batch_look(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
