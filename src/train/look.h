/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One look at a view: its loss, the rate and the penalties, and their gradients. */
#ifndef ADCGS_TRAIN_LOOK_H
#define ADCGS_TRAIN_LOOK_H

#include "train/state.h"

/** Whether bits have a price. */
int adcgs_look_is_rated(const adcgs_trainer *trainer, double progress);

/**
 * The look with this number, counted from the run's first: gradients are added to f->param[].g, what is seen of primitives to
 * stats, and the rest goes to *seen. Nothing else of the run is changed, but for the means that are rounded around, so that
 * looks of one iteration do not depend on each other; adcgs_look_note() does what remains.
 */
adcgs_status adcgs_look(adcgs_trainer *trainer, double progress, uint32_t number, adcgs_train_stats *stats, adcgs_seen *seen,
                        adcgs_error *error);
/** Behind an iteration's looks, for each in their order: follow the exposure of its camera. */
void adcgs_look_note(adcgs_trainer *trainer, double progress, uint32_t number, const adcgs_seen *seen);

#endif
