/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rate control: steering lambda, so that a run ends near a size or a quality. Once it has been sought (rate_search.h), lambda
 * follows the bytes that a stream would take, or the PSNR of training views, as the quantiser of a video encoder follows the
 * fill of its buffer: a proportional and integral controller. Only training views are looked at. Known as rate control in the
 * lambda domain (Li et al. 2014, Lambda domain rate control algorithm for High Efficiency Video Coding, IEEE Trans. Image
 * Processing 23(9)).
 */
#ifndef ADCGS_TRAIN_RATE_CONTROL_H
#define ADCGS_TRAIN_RATE_CONTROL_H

#include "train/state.h"

/**
 * Measure exactly; *off: logarithm of the bytes that features take over those they may take, or so much of the dB over the
 * target. Bits must have been estimated.
 */
adcgs_status adcgs_rate_measure(adcgs_trainer *trainer, double progress, double *off, adcgs_error *error);
/** Within what lambda may be. */
double adcgs_rate_bounded(const adcgs_trainer *trainer, double lambda);
/** Called before each iteration, while anchors are trained: measures now and then, moves lambda. */
adcgs_status adcgs_rate_control_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
