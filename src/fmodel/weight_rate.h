/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * The rate of the networks' own weights: what the weight coder would spend,
 * as a function that has a gradient, so that weights which do not pay shrink.
 */
#ifndef ADCGS_FMODEL_WEIGHT_RATE_H
#define ADCGS_FMODEL_WEIGHT_RATE_H

#include "fmodel/fmodel.h"

/**
 * Estimated bits of a network's weights and biases: each under a Laplace density whose width is the mean magnitude of its row
 * and column, as the coder's context is the size of its neighbours; on the layer's lattice, or before it is chosen one of
 * 2^-ADCGS_E24_BITS. With scale > 0, scale times the gradient is added to that of the group's parameters.
 */
double adcgs_weight_rate(adcgs_fmodel *f, int group, float scale);

#endif
