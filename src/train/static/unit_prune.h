/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Structured pruning of networks: hidden units that are not worth their bits are removed, and the others are refitted to replace
 * them (decision D13). The refit by least squares follows He, Zhang and Sun 2017, Channel pruning, ICCV, and for single weights
 * Hassibi and Stork 1993, Optimal brain surgeon, NIPS.
 */
#ifndef ADCGS_TRAIN_STATIC_UNIT_PRUNE_H
#define ADCGS_TRAIN_STATIC_UNIT_PRUNE_H

#include "train/state/state.h"

/**
 * Correlations of a network's hidden activations: the inverse of the sums, over samples, of products of all pairs of inputs of
 * each layer except the first. The last input is a 1, for the biases.
 */
typedef struct adcgs_gram {
    int n;                                 /**< width + 1 */
    double *inverse[ADCGS_MLP_LAYERS - 1]; /**< [n][n] of the inputs of layers 1.. */
} adcgs_gram;

/** Samples a share of the model's anchors, primitives and times. Free with adcgs_gram_clear(). */
adcgs_status adcgs_gram_take(adcgs_gram *gram, const adcgs_fmodel *f, int group, adcgs_error *error);
void adcgs_gram_clear(adcgs_gram *gram);

/**
 * Zeroes the weights that read hidden unit `unit`, and changes the weights that read the others, and the biases. The layers' sums
 * stay as close as linear regression allows. gram is updated; a unit can be removed once.
 */
void adcgs_mlp_prune_unit(const adcgs_mlp *mlp, float *p, adcgs_gram *gram, int unit);

/** Removes the hidden units of a network with keep[unit] 0: parameters and Adam moments of the others are compacted. */
void adcgs_fmodel_narrow(adcgs_fmodel *f, int group, const uint8_t *keep);

/**
 * Removes units one after the other, first those with the least effect on the layers after them. Keeps the state in which the
 * image loss (or the features' bits) and the networks' bits have the least total cost.
 */
adcgs_status adcgs_prune_units(adcgs_trainer *trainer, adcgs_error *error);

#endif
