/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What the pictures themselves say of stillness. Where those of a camera that stays where it is never change, nothing moves,
 * whatever the networks make of it.
 */
#ifndef ADCGS_TRAIN_UNCHANGING_H
#define ADCGS_TRAIN_UNCHANGING_H

#include "train/state.h"

/**
 * Share of all that an anchor is drawn with, over pictures of cameras that stay where they are and take several, that lies in
 * pixels which change by more than their noise, more than can be seen, and more than is not worth following by the errors that
 * are left; share: [anchors], -1 for what no such picture shows.
 */
adcgs_status adcgs_changing_share(adcgs_trainer *trainer, float *share, adcgs_error *error);

#endif
