/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * From a stream's numbers to the float model, for a run that continues the previous segment. A predicted segment shares the
 * meaning of values with the previous one. So steps, prior, and the networks that define this meaning are frozen. An anchor is
 * unchanged until it is trained.
 */
#ifndef ADCGS_FMODEL_FROM_MODEL_H
#define ADCGS_FMODEL_FROM_MODEL_H

#include "fmodel/fmodel.h"

/**
 * Creates the float model whose quantisation is `model`. shape and params of the run must match the model except in widths;
 * otherwise ADCGS_ERR_DATA. All anchors are frozen.
 */
adcgs_status adcgs_fmodel_from_model(adcgs_fmodel **out, const adcgs_model *model, const adcgs_shape *shape, uint64_t seed,
                                     adcgs_cpu_level cpu, adcgs_error *error);

/** True if a parameter group defines the meaning of values, and so is frozen in a model that continues another. */
int adcgs_fmodel_is_settled(const adcgs_fmodel *f, int group);

#endif
