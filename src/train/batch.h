/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The view passes of an iteration, config.batch of them, and the mean of their gradients. The runs of a team share the passes and
 * all receive the result.
 */
#ifndef ADCGS_TRAIN_BATCH_H
#define ADCGS_TRAIN_BATCH_H

#include "train/state/state.h"

/**
 * Runs an iteration's view passes. f->param[].g receives the mean gradients, the statistics are updated, and
 * trainer->batch.results receives the results of each view. Gradients and statistics are summed by a tree over the views
 * (tree_sum.h).
 */
adcgs_status adcgs_batch_run(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
