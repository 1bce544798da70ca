/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Interface of training to the code that builds streams: exact quantisation, plain or rate-distortion optimised, and the input of
 * the latter.
 */
#ifndef ADCGS_FMODEL_RDO_INPUT_H
#define ADCGS_FMODEL_RDO_INPUT_H

#include "fmodel/fmodel.h"

/**
 * Costs for the choice of levels: a value at a distance d from its target costs curvature/2 * d^2 of loss, a bit costs lambda_bit
 * of loss. Arrays are laid out like the parameters. A group with a curvature of NULL takes the nearest levels.
 */
typedef struct adcgs_rdo {
    const float *target[ADCGS_P_ANCHOR];
    const float *curvature[ADCGS_P_ANCHOR]; /**< second derivative of the mean loss with respect to each value; >= 0 */
    double lambda_bit;                      /**< >= 0; 0 gives the nearest levels */
} adcgs_rdo;

typedef struct adcgs_quantise_options {
    adcgs_cpu_level cpu;  /**< resolved */
    float *const *mu;     /**< [ADCGS_P_ANCHOR] or NULL: receives predicted means, packed, laid out like the parameters */
    float *factor;        /**< NULL, or receives factors of steps, as in adcgs_pass */
    float *const *value;  /**< [ADCGS_P_ANCHOR] or NULL: receives decoded values; may be the parameters themselves */
    const adcgs_rdo *rdo; /**< NULL: the levels nearest to the parameters */
} adcgs_quantise_options;

/** Quantises a model as its stream will hold it. */
typedef adcgs_status (*adcgs_train_quantise)(const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error);

#endif
