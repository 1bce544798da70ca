/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rate control: lambda is controlled so that a run ends near a size or a quality. After the search (rate_search.h), lambda
 * follows the predicted bytes of the stream, or the PSNR of training views. It works like the quantiser of a video encoder, which
 * follows the fill of its buffer: a proportional-integral controller. Only training views are used. Known as rate control in the
 * lambda domain (Li et al. 2014, Lambda domain rate control algorithm for High Efficiency Video Coding, IEEE Trans. Image
 * Processing 23(9)).
 */
#ifndef ADCGS_TRAIN_RATE_RATE_CONTROL_H
#define ADCGS_TRAIN_RATE_RATE_CONTROL_H

#include "train/state/state.h"

/**
 * Measures exactly. *off: logarithm of the features' bytes over the bytes available for them, or a multiple of the dB above the
 * target. Bits must have been estimated.
 */
adcgs_status adcgs_rate_measure(adcgs_trainer *trainer, double progress, double *off, adcgs_error *error);
/** Clamps lambda to its allowed range. */
double adcgs_rate_bounded(const adcgs_trainer *trainer, double lambda);
/** Called before each iteration while anchors are trained: measures periodically, and updates lambda. */
adcgs_status adcgs_rate_control_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
