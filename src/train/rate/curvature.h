/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Curvature: the second derivative of the mean training loss with respect to each anchor value. */
#ifndef ADCGS_TRAIN_RATE_CURVATURE_H
#define ADCGS_TRAIN_RATE_CURVATURE_H

#include "train/state/state.h"

/** Maximum number of training views used; chosen by hand, not measured. */
enum { ADCGS_CURVATURE_VIEWS = 64 };

/**
 * h[group], laid out like f's parameters, receives the estimate for every anchor value of the current model, without rounding or
 * noise. It is the diagonal of the Gauss-Newton matrix of the image squares, by random projection of each image onto one
 * gradient. A factor per group calibrates it to the measured change of the loss when all its values move by a quarter of a step.
 * eta, on which no image depends, gets 0. Deterministic. ratio, if not NULL, receives the factors.
 */
adcgs_status adcgs_curvature_measure(adcgs_trainer *trainer, float *const h[ADCGS_P_ANCHOR], double ratio[ADCGS_P_ANCHOR],
                                     adcgs_error *error);

#endif
