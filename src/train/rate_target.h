/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Meeting a size or a quality exactly, when values are frozen and once more at the end: the strength of the choice of levels
 * (levels.h) is sought at which the target is met, as video encoders of two passes settle on a quantiser.
 */
#ifndef ADCGS_TRAIN_RATE_TARGET_H
#define ADCGS_TRAIN_RATE_TARGET_H

#include "train/state.h"

/**
 * Called when rounding begins, and again before values are frozen: where a size has room left, all quantiser steps become finer
 * by one factor. What lambda has thrown away does not come back by itself.
 */
adcgs_status adcgs_rate_target_steps(adcgs_trainer *trainer, int first, adcgs_error *error);
/**
 * Called when values have just been frozen: meets the target less what training the networks will change, or goes back
 * (adcgs_rate_search_end()).
 */
adcgs_status adcgs_rate_target_frozen(adcgs_trainer *trainer, adcgs_error *error);
/** Called at the end, values frozen: meets the target if it is not met, as far as that can be. */
adcgs_status adcgs_rate_target_finish(adcgs_trainer *trainer, adcgs_error *error);

#endif
