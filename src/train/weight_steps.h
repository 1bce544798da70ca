/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What the networks' weights cost on a lattice, and which lattice is worth it (decision D6). Known as mixed-precision
 * quantisation (Dong et al. 2019, HAWQ, ICCV), here by rate and distortion in place of a bound on the bits.
 */
#ifndef ADCGS_TRAIN_WEIGHT_STEPS_H
#define ADCGS_TRAIN_WEIGHT_STEPS_H

#include "train/state.h"

/** Exponents a lattice may have: 2^-e is the distance of its points. Entropy networks: at most ADCGS_E24_BITS. */
enum { ADCGS_WEIGHT_STEP_MIN = 0, ADCGS_WEIGHT_STEP_MAX = 16 };

/** Bits that the weight coder spends on a layer's weights and biases, p being the network's parameters, rounded to 2^-e. */
adcgs_status adcgs_weight_step_bits(const adcgs_mlp *mlp, const float *p, int layer, int e, double *bits, adcgs_error *error);

/** Lattices from the sizes of the weights alone: what adcgs_weight_steps_choose() begins at. */
void adcgs_weight_steps_nominal(adcgs_trainer *trainer);

/**
 * Choose the lattice of every layer: of the exponents the one whose loss, measured on some training views, and bits, counted
 * by the coders, cost the least together. An entropy network's loss is what the features' bits grow by. With
 * config.without_weight_steps the networks that are binary32 stay so, and the others are on the finest lattice they can have.
 */
adcgs_status adcgs_weight_steps_choose(adcgs_trainer *trainer, adcgs_error *error);

#endif
