/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the float model to the numbers a stream carries: integer entropy
 * networks, latents quantised around their exact means, weights on their
 * lattices.
 */
#ifndef ADCGS_ENCODE_QUANTISE_H
#define ADCGS_ENCODE_QUANTISE_H

#include "model/latents.h"
#include "train/pass.h"

/**
 * Build the model of f. Anchors are f's, in their Morton order. mu, value: if not NULL, receive per anchor group the predicted
 * means (1/64 step) and the decoded values, laid out like f's parameters. The caller clears the model.
 */
adcgs_status adcgs_quantise(adcgs_model *model, const adcgs_fmodel *f, adcgs_cpu_level cpu, float *const mu[ADCGS_P_ANCHOR],
                            float *const value[ADCGS_P_ANCHOR], adcgs_error *error);

#endif
