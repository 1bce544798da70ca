/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Detail in order of worth: anchors in tiers, of which the first ones alone are a coarse picture of everything (spec clause
 * "Tiers"). They are found by elimination: what changes the pictures least goes first, and what is left is measured anew, as in
 * Guyon et al. 2002, Gene selection, Machine Learning 46. Then the run goes on for all tiers at once.
 */
#ifndef ADCGS_TRAIN_TIERS_H
#define ADCGS_TRAIN_TIERS_H

#include "train/state.h"

/** Give each anchor its tier, as many as the configuration wants and the anchors suffice for; and primitives their growth. */
adcgs_status adcgs_tiers_assign(adcgs_trainer *trainer, adcgs_error *error);
/** How large primitives are best while tiers are absent, of the values as they are now. */
adcgs_status adcgs_tiers_fit(adcgs_trainer *trainer, adcgs_error *error);
/**
 * In some iterations, behind its backward pass: add the gradients of what this view looks like while tiers are absent. mode: of
 * the iteration's forward pass.
 */
adcgs_status adcgs_tiers_learn(adcgs_trainer *trainer, uint32_t view, const adcgs_pass_mode *mode, adcgs_error *error);

#endif
