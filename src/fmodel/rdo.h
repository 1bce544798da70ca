/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What training asks of the room that builds streams: exact quantisation,
 * plain or by rate and distortion; and what it gives for the latter.
 */
#ifndef ADCGS_FMODEL_RDO_H
#define ADCGS_FMODEL_RDO_H

#include "fmodel/fmodel.h"

/**
 * The price list of a choice among levels: a value that ends at a distance d from its target costs curvature/2 * d^2 of loss, a
 * bit costs lambda_bit of loss. Arrays are laid out like the parameters; a group whose curvature is NULL takes the nearest level.
 */
typedef struct adcgs_rdo {
    const float *target[ADCGS_P_ANCHOR];
    const float *curvature[ADCGS_P_ANCHOR]; /**< second derivative of the mean loss by each value; >= 0 */
    double lambda_bit;                      /**< >= 0; 0 gives the nearest levels */
} adcgs_rdo;

typedef struct adcgs_quantise_options {
    adcgs_cpu_level cpu;  /**< resolved */
    float *const *mu;     /**< [ADCGS_P_ANCHOR] or NULL: receives predicted means, packed, laid out like the parameters */
    float *factor;        /**< NULL, or receives factors of steps, as adcgs_pass has them */
    float *const *value;  /**< [ADCGS_P_ANCHOR] or NULL: receives decoded values; may be the parameters themselves */
    const adcgs_rdo *rdo; /**< NULL: the levels nearest to the parameters */
} adcgs_quantise_options;

/** Quantise a model as its stream will hold it. */
typedef adcgs_status (*adcgs_train_quantise)(const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error);

#endif
