/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Mean of a model's parameters over some iterations. Every iteration sees one view and steps towards it; the mean of where
 * many of them led is nearer to what suits all views than where the last one led. Known as stochastic weight averaging (Izmailov
 * et al. 2018, Averaging weights leads to wider optima and better generalization, UAI).
 */
#ifndef ADCGS_FMODEL_WEIGHT_AVERAGE_H
#define ADCGS_FMODEL_WEIGHT_AVERAGE_H

#include "fmodel/fmodel.h"

/** Zero-initialise before use. */
typedef struct adcgs_weight_average {
    uint32_t n;   /**< iterations in it */
    size_t size;  /**< parameters */
    float *mean;  /**< [size], groups one after the other */
} adcgs_weight_average;

/** Begin anew, with room for f's parameters. */
adcgs_status adcgs_weight_average_begin(adcgs_weight_average *average, const adcgs_fmodel *f, adcgs_error *error);
/** Add f's parameters as they are. Begins anew if their number is another one. */
adcgs_status adcgs_weight_average_add(adcgs_weight_average *average, const adcgs_fmodel *f, adcgs_error *error);
/** Give f the mean, if there is one, and forget it. */
void adcgs_weight_average_take(adcgs_weight_average *average, adcgs_fmodel *f);
void adcgs_weight_average_clear(adcgs_weight_average *average);

#endif
