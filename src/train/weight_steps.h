/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the networks' weights cost on a lattice, and which lattice is worth it (decision D6). */
#ifndef ADCGS_TRAIN_WEIGHT_STEPS_H
#define ADCGS_TRAIN_WEIGHT_STEPS_H

#include "train/trainer.h"

/** Exponents a lattice may have: 2^-e is the distance of its points. Entropy networks: at most ADCGS_E24_BITS. */
enum { ADCGS_LATTICE_MIN = 0, ADCGS_LATTICE_MAX = 16 };

/** Bits that the weight coder spends on a layer's weights and biases, p being the network's parameters, rounded to 2^-e. */
adcgs_status adcgs_lattice_bits(const adcgs_mlp *mlp, const float *p, int layer, int e, double *bits, adcgs_error *error);

/**
 * What a network of now costs elsewhere, in bits at lambda's price: the loss of some training views, or for an entropy network
 * (which must be on its lattice) the features' bits.
 */
adcgs_status adcgs_trainer_distortion(adcgs_trainer *trainer, int group, double *bits, adcgs_error *error);

/** Lattices from the sizes of the weights alone: what adcgs_trainer_choose_lattices() begins at. */
void adcgs_trainer_lattices(adcgs_trainer *trainer);

/**
 * Choose the lattice of every layer: of the exponents the one whose loss, measured on some training views, and bits, counted
 * by the coders, cost the least together. An entropy network's loss is what the features' bits grow by. With
 * config.without_lattice the networks that are binary32 stay so, and the others are on the finest lattice they can have.
 */
adcgs_status adcgs_trainer_choose_lattices(adcgs_trainer *trainer, adcgs_error *error);

#endif
