/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From the numbers of a stream back to the float model, for a run that goes on with the segment before: a predicted segment
 * shares the meaning of values with it, so steps, prior, and the networks that give values their meaning are settled, and an
 * anchor stays what it is until it learns.
 */
#ifndef ADCGS_FMODEL_FROM_MODEL_H
#define ADCGS_FMODEL_FROM_MODEL_H

#include "fmodel/fmodel.h"

/**
 * The float model whose quantisation the model is. shape and params are those of the run, which have to be the model's but for
 * widths; no anchor learns. ADCGS_ERR_DATA where they are not.
 */
adcgs_status adcgs_fmodel_from_model(adcgs_fmodel **out, const adcgs_model *model, const adcgs_shape *shape, uint64_t seed,
                                     adcgs_cpu_level cpu, adcgs_error *error);

/** Whether a parameter group says what values mean, and is settled where a model goes on with another. */
int adcgs_fmodel_is_settled(const adcgs_fmodel *f, int group);

#endif
