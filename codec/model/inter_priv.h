/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Declarations that the files about kept anchors share. */
#ifndef ADCGS_MODEL_INTER_PRIV_H
#define ADCGS_MODEL_INTER_PRIV_H

#include "model/inter.h"

/** Number of channels of a group, and its rows in a model. */
int adcgs_inter_channels(const adcgs_params *params, int group);
int16_t *adcgs_inter_rows(const adcgs_model *model, int group);
/** The least number of steps from one latent to another. If no number leads there, a number that does not. */
int32_t adcgs_inter_difference(int32_t before, int32_t now);
/** Allocate *kept for a model's anchors, with its rows. On failure the caller clears the parts that were allocated. */
adcgs_status adcgs_inter_alloc(adcgs_inter *kept, const adcgs_model *before, adcgs_memory *memory, adcgs_error *error);

#endif
