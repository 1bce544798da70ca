/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What fits into a size: before a run, it decides how many anchors and how wide networks there can be. */
#ifndef ADCGS_TRAIN_RATE_PLAN_H
#define ADCGS_TRAIN_RATE_PLAN_H

#include "train/schedule.h"

/** Bits that a weight takes in a stream, about. */
#define ADCGS_WEIGHT_BITS 7

/**
 * Fit the budget of anchors and the widths of the networks into a size, unless they were chosen by hand. ADCGS_ERR_USAGE if not
 * even the smallest networks and a few anchors fit.
 */
adcgs_status adcgs_rate_plan(adcgs_train_config *config, adcgs_error *error);

#endif
