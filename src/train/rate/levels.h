/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rate-distortion optimised quantisation of a frozen run. Each value gets the level whose bits and whose loss, by the curvature,
 * have the least total cost. Known as RDOQ in video coding.
 */
#ifndef ADCGS_TRAIN_RATE_LEVELS_H
#define ADCGS_TRAIN_RATE_LEVELS_H

#include "train/state/state.h"

/** Parameters for a frozen trainer: lambda_bit is strength times the run's loss per bit. ADCGS_ERR_USAGE if it is not frozen. */
adcgs_status adcgs_level_costs(const adcgs_trainer *trainer, double strength, adcgs_rdo *rdo, adcgs_error *error);

/**
 * Quantises the values of a frozen trainer again from the same unquantised values, with another strength (0: nearest levels).
 * Without further training, adcgs_encode_stream() then writes as many bytes as adcgs_encode_bytes() gave for this strength.
 */
adcgs_status adcgs_level_choose(adcgs_trainer *trainer, double strength, adcgs_error *error);

/** Stores the bits of the coder for the rounded values of each channel group. */
void adcgs_level_bits(adcgs_trainer *trainer);

#endif
