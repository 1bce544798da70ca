/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rate of the networks' weights: a differentiable estimate of the weight coder's bits, so that weights that are not worth them
 * shrink.
 */
#ifndef ADCGS_FMODEL_WEIGHT_RATE_H
#define ADCGS_FMODEL_WEIGHT_RATE_H

#include "fmodel/fmodel.h"

/**
 * Estimated bits of a network's weights and biases. Each is under a Laplace density whose width is the mean magnitude of its row
 * and column, as the coder's context is the size of neighbours. The lattice is the layer's or, before it is chosen,
 * 2^-ADCGS_E24_BITS. With scale > 0, scale times the gradient is added to that of the group's parameters.
 */
double adcgs_weight_rate(adcgs_fmodel *f, int group, float scale);

#endif
