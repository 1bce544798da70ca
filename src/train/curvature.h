/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How much loss an error of each anchor value costs: the second derivative of the mean loss of the training views. */
#ifndef ADCGS_TRAIN_CURVATURE_H
#define ADCGS_TRAIN_CURVATURE_H

#include "train/state.h"

/** Most training views that are looked at. */
enum { ADCGS_CURVATURE_VIEWS = 64 };

/**
 * h[group], laid out like f's parameters, receives the estimate for every anchor value of the model as it is: no rounding, no
 * noise, networks as they are used. It is the diagonal of the Gauss-Newton matrix of the pictures' squares, by random projection
 * of each picture onto one gradient, times a factor per group that makes it predict what the loss was seen to do when all the
 * group's values move by a quarter of a step. eta, which no picture shows, gets 0. Deterministic. ratio, if not NULL, receives
 * the factors.
 */
adcgs_status adcgs_curvature_measure(adcgs_trainer *trainer, float *const h[ADCGS_P_ANCHOR], double ratio[ADCGS_P_ANCHOR],
                                     adcgs_error *error);

#endif
