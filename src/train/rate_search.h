/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The lambda of a size or a quality. What it throws away early does not come back, and what it keeps early hardly goes: from
 * where rate counts until it is decided what stays, a run with a target has one lambda. By then its bytes are known within a few
 * percent of what they will be, its PSNR within some tenths; where they do not suit, it goes back to where rate began, with a
 * lambda that suits better. From there on lambda is steered (rate_control.h).
 */
#ifndef ADCGS_TRAIN_RATE_SEARCH_H
#define ADCGS_TRAIN_RATE_SEARCH_H

#include "train/state.h"

/** Whether it is still sought. A run that counts time cannot go back. */
int adcgs_rate_is_sought(const adcgs_trainer *trainer);
/** Called before each iteration in which that is so. Going back, t->iteration is less than it was: progress is another then. */
adcgs_status adcgs_rate_search_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

/**
 * Called when values have been frozen, which have so many dB less than they should, less than 0 if more. Once, if they have less,
 * a run that lambda was sought of goes back as above.
 */
adcgs_status adcgs_rate_search_end(adcgs_trainer *trainer, double missing, adcgs_error *error);

#endif
