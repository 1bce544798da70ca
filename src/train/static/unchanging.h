/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Static content by the images alone. Where the images of a static camera never change, nothing moves, even if the networks
 * predict motion.
 */
#ifndef ADCGS_TRAIN_STATIC_UNCHANGING_H
#define ADCGS_TRAIN_STATIC_UNCHANGING_H

#include "train/state/state.h"

/**
 * Share of an anchor's rendered weight at changing pixels, over images of static cameras with several images. A change counts if
 * it exceeds the noise and the visible threshold, and is worth modelling in view of the remaining error. share: [anchors], -1 for
 * anchors that no such image shows.
 */
adcgs_status adcgs_changing_share(adcgs_trainer *trainer, float *share, adcgs_error *error);

#endif
