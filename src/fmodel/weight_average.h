/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Mean of a model's parameters over some iterations. Every iteration sees one view and steps towards it. The mean over many
 * iterations suits all views better than the last one. Known as stochastic weight averaging (Izmailov et al. 2018, Averaging
 * weights leads to wider optima and better generalization, UAI).
 */
#ifndef ADCGS_FMODEL_WEIGHT_AVERAGE_H
#define ADCGS_FMODEL_WEIGHT_AVERAGE_H

#include "fmodel/fmodel.h"

/** Zero-initialise before use. */
typedef struct adcgs_weight_average {
    uint32_t n;  /**< number of iterations */
    size_t size; /**< number of parameters */
    float *mean; /**< [size], groups one after the other */
} adcgs_weight_average;

/** Resets the mean, with room for f's parameters. */
adcgs_status adcgs_weight_average_begin(adcgs_weight_average *average, const adcgs_fmodel *f, adcgs_error *error);
/** Adds f's current parameters. Resets the mean if their number has changed. */
adcgs_status adcgs_weight_average_add(adcgs_weight_average *average, const adcgs_fmodel *f, adcgs_error *error);
/** Copies the mean to f, if there is one, and resets it. */
void adcgs_weight_average_take(adcgs_weight_average *average, adcgs_fmodel *f);
void adcgs_weight_average_clear(adcgs_weight_average *average);

#endif
