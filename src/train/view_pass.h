/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One view pass: its loss, the rate and the penalties, and their gradients. */
#ifndef ADCGS_TRAIN_VIEW_PASS_H
#define ADCGS_TRAIN_VIEW_PASS_H

#include "train/state/state.h"

/** True if the rate is part of the loss. */
int adcgs_view_pass_has_rate(const adcgs_trainer *trainer, double progress);

/**
 * Runs the view pass with this number, counted from the start of the run. Gradients are added to f->param[].g, visibility of
 * primitives to stats, and the rest goes to *result. Except for the means used in rounding, nothing else changes, so passes of
 * one iteration are independent. adcgs_view_pass_apply() does the rest.
 */
adcgs_status adcgs_view_pass(adcgs_trainer *trainer, double progress, uint32_t number, adcgs_train_stats *stats,
                             adcgs_view_result *result, adcgs_error *error);
/** Called after an iteration's view passes, for each in order: updates the exposure of its camera. */
void adcgs_view_pass_apply(adcgs_trainer *trainer, double progress, uint32_t number, const adcgs_view_result *result);

#endif
