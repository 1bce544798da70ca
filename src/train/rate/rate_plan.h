/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Plan for a size: decides before a run how many anchors and how wide networks fit. */
#ifndef ADCGS_TRAIN_RATE_RATE_PLAN_H
#define ADCGS_TRAIN_RATE_RATE_PLAN_H

#include "train/train_config.h"

/** Bits of a weight in a stream, approximately; chosen by hand, not measured. */
#define ADCGS_WEIGHT_BITS 7

/** Values that suit the target. */
typedef struct adcgs_rate_plan {
    float lambda; /**< of the start of a search */
    adcgs_shape shape;
    uint32_t start_anchors, max_anchors;
} adcgs_rate_plan;

/**
 * Fits the budget of anchors and the widths of the networks into a size, unless the user gave them. The plan of a run
 * without a target has the values of the configuration. ADCGS_ERR_USAGE if not even the smallest networks and a few anchors fit.
 */
adcgs_status adcgs_rate_plan_make(adcgs_rate_plan *plan, const adcgs_train_config *config, adcgs_error *error);

#endif
