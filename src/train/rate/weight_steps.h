/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Lattices of the networks' weights: their cost and their choice (decision D6). Known as mixed-precision quantisation (Dong et
 * al. 2019, HAWQ, ICCV), here by rate and distortion in place of a bound on the bits.
 */
#ifndef ADCGS_TRAIN_RATE_WEIGHT_STEPS_H
#define ADCGS_TRAIN_RATE_WEIGHT_STEPS_H

#include "train/state/state.h"

/**
 * Range of a lattice's exponent: 2^-e is the distance of its points. Entropy networks: at most ADCGS_E24_BITS. Bits, definition
 * of the format.
 */
enum { ADCGS_WEIGHT_STEP_MIN = 0, ADCGS_WEIGHT_STEP_MAX = 16 };

/** Bits that the weight coder spends on a layer's weights and biases, rounded to 2^-e. p: the network's parameters. */
adcgs_status adcgs_weight_step_bits(const adcgs_mlp *mlp, const float *p, int layer, int e, double *bits, adcgs_error *error);

/** Sets lattices from the magnitudes of the weights alone; the starting point of adcgs_weight_steps_choose(). */
void adcgs_weight_steps_nominal(adcgs_trainer *trainer);

/**
 * Chooses the lattice of every layer: the exponent with the least total cost of loss, measured on some training views, and bits,
 * counted by the coders. An entropy network's loss is the increase of the features' bits. With config.without_weight_steps,
 * networks stored as binary32 stay so, and the others use their finest lattice.
 */
adcgs_status adcgs_weight_steps_choose(adcgs_trainer *trainer, adcgs_error *error);

#endif
