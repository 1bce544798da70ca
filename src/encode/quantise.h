/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the float model to the numbers a stream carries: integer entropy
 * networks, latents quantised around their exact means, weights on their
 * lattices.
 */
#ifndef ADCGS_ENCODE_QUANTISE_H
#define ADCGS_ENCODE_QUANTISE_H

#include "fmodel/rdo.h"
#include "model/latents.h"

/**
 * Build the model of f. Anchors are f's, in their Morton order. Values that lie on levels already, as those of a frozen model
 * do, come out as they are. The caller clears the model.
 */
adcgs_status adcgs_quantise(adcgs_model *model, const adcgs_fmodel *f, const adcgs_quantise_options *options,
                            adcgs_error *error);

#endif
