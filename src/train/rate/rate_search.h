/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Search for the lambda of a size or a quality. Content discarded early does not come back, and content kept early hardly goes.
 * So a run with a target has one lambda from rate_start until after prune_at. By then its final bytes are known within a few
 * percent, and its PSNR within some tenths. If they do not fit, the run returns to rate_start with a better lambda. After the
 * search, lambda is controlled (rate_control.h).
 */
#ifndef ADCGS_TRAIN_RATE_RATE_SEARCH_H
#define ADCGS_TRAIN_RATE_RATE_SEARCH_H

#include "train/state/state.h"

/** True if the search is not finished. A run with a time limit cannot return. */
int adcgs_rate_is_sought(const adcgs_trainer *trainer);
/** Called before each iteration during the search. A try that fails sets rate.next_lambda. */
adcgs_status adcgs_rate_search_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

/**
 * Called after values are frozen. missing: dB below the target, negative if above. On the first shortfall, a run with a search
 * sets rate.next_lambda.
 */
void adcgs_rate_search_end(adcgs_trainer *trainer, double missing);
/**
 * Restores the state at rate_start, except lambda, which becomes rate.next_lambda, and the elapsed time. The training
 * loop calls it where rate.next_lambda is set: run.iteration decreases, and so progress.
 */
adcgs_status adcgs_rate_search_return(adcgs_trainer *trainer, adcgs_error *error);

#endif
