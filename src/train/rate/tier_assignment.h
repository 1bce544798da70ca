/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Progressive detail: anchors in tiers. The first tiers alone give a coarse render of the whole scene (spec clause "Tiers"). The
 * assignment works by elimination: anchors with the least effect on the renders go first, and the rest are measured again, as in
 * Guyon et al. 2002, Gene selection, Machine Learning 46. Afterwards the run continues with all tiers together.
 */
#ifndef ADCGS_TRAIN_RATE_TIER_ASSIGNMENT_H
#define ADCGS_TRAIN_RATE_TIER_ASSIGNMENT_H

#include "train/state/state.h"

/** Assigns each anchor to a tier, as many as configured and as the anchors suffice for, and sets the growth of primitives. */
adcgs_status adcgs_tiers_assign(adcgs_trainer *trainer, adcgs_error *error);
/** Fits the growth of primitives for missing tiers to the current values. */
adcgs_status adcgs_tiers_fit(adcgs_trainer *trainer, adcgs_error *error);
/**
 * Called in some iterations after the backward pass: adds the gradients of this view's render without the later tiers. mode: of
 * the iteration's forward pass.
 */
adcgs_status adcgs_tiers_train(adcgs_trainer *trainer, uint32_t view, const adcgs_pass_mode *mode, adcgs_error *error);

#endif
