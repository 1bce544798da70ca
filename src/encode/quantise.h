/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the float model to the numbers of a stream: integer entropy networks, latents quantised around their exact means, and
 * weights on their lattices.
 */
#ifndef ADCGS_ENCODE_QUANTISE_H
#define ADCGS_ENCODE_QUANTISE_H

#include "fmodel/rdo_input.h"
#include "model/latents.h"

/**
 * Builds the model of f. Anchors keep f's order (Morton). Values that already lie on levels, like those of a frozen model, stay
 * unchanged. The caller clears the model.
 */
adcgs_status adcgs_quantise(adcgs_model *model, const adcgs_fmodel *f, const adcgs_quantise_options *options, adcgs_error *error);

#endif
