/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Plan for a size: decides before a run how many anchors and how wide networks fit. */
#ifndef ADCGS_TRAIN_RATE_RATE_PLAN_H
#define ADCGS_TRAIN_RATE_RATE_PLAN_H

#include "train/schedule.h"

/** Bits of a weight in a stream, approximately; chosen by hand, not measured. */
#define ADCGS_WEIGHT_BITS 7

/**
 * Fits the budget of anchors and the widths of the networks into a size, unless the user set them. ADCGS_ERR_USAGE if not even
 * the smallest networks and a few anchors fit.
 */
adcgs_status adcgs_rate_plan(adcgs_train_config *config, adcgs_error *error);

#endif
