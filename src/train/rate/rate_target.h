/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Meeting a size or a quality exactly, when values are frozen and again at the end. A search finds the strength of RDOQ
 * (levels.h) that meets the target, as two-pass video encoders settle on a quantiser.
 */
#ifndef ADCGS_TRAIN_RATE_RATE_TARGET_H
#define ADCGS_TRAIN_RATE_RATE_TARGET_H

#include "train/state/state.h"

/**
 * Called when rounding begins, and again before values are frozen. If a size has room left, one factor refines all quantiser
 * steps. Content discarded by lambda does not come back by itself.
 */
adcgs_status adcgs_rate_target_steps(adcgs_trainer *trainer, int first, adcgs_error *error);
/**
 * Called right after values are frozen. Meets the target minus the expected effect of training the networks, or returns
 * early (adcgs_rate_search_end()).
 */
adcgs_status adcgs_rate_target_frozen(adcgs_trainer *trainer, adcgs_error *error);
/** Called at the end with frozen values: meets the target as closely as possible, if it is not met yet. */
adcgs_status adcgs_rate_target_finish(adcgs_trainer *trainer, adcgs_error *error);

#endif
