/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Narrower networks: hidden units that do not pay for their bits are removed,
 * and what the others can do of their work is given to them (decision D13).
 * Known as structured pruning; that the others are fitted by least squares is
 * as in He, Zhang and Sun 2017, Channel pruning, ICCV, and for single weights
 * in Hassibi and Stork 1993, Optimal brain surgeon, NIPS.
 */
#ifndef ADCGS_TRAIN_UNIT_PRUNE_H
#define ADCGS_TRAIN_UNIT_PRUNE_H

#include "train/state.h"

/**
 * How a network's hidden activations go together: the inverse of the sums, over samples, of products of every two inputs of each
 * layer but the first. The last input is a 1, for the biases.
 */
typedef struct adcgs_gram {
    int n;                                 /**< width + 1 */
    double *inverse[ADCGS_MLP_LAYERS - 1]; /**< [n][n] of the inputs of layers 1.. */
} adcgs_gram;

/** Over a share of the model's anchors, primitives and times. To be freed by adcgs_gram_clear(). */
adcgs_status adcgs_gram_take(adcgs_gram *gram, const adcgs_fmodel *f, int group, adcgs_error *error);
void adcgs_gram_clear(adcgs_gram *gram);

/**
 * Zero the weights that read hidden unit `unit` and change those that read the others, biases too, so that the sums of every
 * layer stay as they are as nearly as linear regression can make them. gram follows; a unit can be silenced once.
 */
void adcgs_mlp_silence(const adcgs_mlp *mlp, float *p, adcgs_gram *gram, int unit);

/** Remove the hidden units of a network where keep[unit] is 0: parameters and Adam's moments of the others move together. */
void adcgs_fmodel_narrow(adcgs_fmodel *f, int group, const uint8_t *keep);

/**
 * Silence units one after the other, those first whose absence the layers after them feel least; remove those before the point
 * where what the pictures (or the features' bits) lose and the networks' bits cost the least together.
 */
adcgs_status adcgs_prune_units(adcgs_trainer *trainer, adcgs_error *error);

#endif
