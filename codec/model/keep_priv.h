/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What the files about kept anchors share. */
#ifndef ADCGS_MODEL_KEEP_PRIV_H
#define ADCGS_MODEL_KEEP_PRIV_H

#include "model/keep.h"

/** Channels of a group, and its rows in a model. */
int adcgs_keep_channels(const adcgs_params *params, int group);
int16_t *adcgs_keep_rows(const adcgs_model *model, int group);
/** The least number of steps from one latent to another, or, where none leads there, one that does not. */
int32_t adcgs_keep_difference(int32_t before, int32_t now);
/** Room for what is kept of a model; rows are the model's. On failure the caller clears what is there. */
adcgs_status adcgs_kept_alloc(adcgs_keep *kept, const adcgs_model *before, adcgs_memory *memory, adcgs_error *error);

#endif
