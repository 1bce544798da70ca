/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Pictures that come twice. A recorder that misses a frame repeats the one before: such a picture shows what was there a moment
 * ago, and who learns it as of its own time draws what moves over both places.
 */
#ifndef ADCGS_TRAIN_DOUBLED_H
#define ADCGS_TRAIN_DOUBLED_H

#include "train/state.h"

/**
 * Set trainer->doubled, for who tells of it, and where the run is to, times of the training views: their own, in [0,1], but that
 * of the picture before for one that is the same once more (data/faults.h). glances: of all training views.
 */
adcgs_status adcgs_doubled_find(adcgs_trainer *trainer, const adcgs_glance *glances, adcgs_error *error);

#endif
