/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The choice of levels of a frozen run by rate and distortion: each value's level is the one whose bits and whose loss, by the
 * curvature there, cost the least together. Known as rate-distortion optimised quantisation (RDOQ) in video coding.
 */
#ifndef ADCGS_TRAIN_LEVELS_H
#define ADCGS_TRAIN_LEVELS_H

#include "train/state.h"

/** The prices of a frozen trainer at a strength: lambda_bit is the run's loss per bit times strength. ADCGS_ERR_USAGE before. */
adcgs_status adcgs_level_prices(const adcgs_trainer *trainer, double strength, adcgs_rdo *rdo, adcgs_error *error);

/**
 * Decide the values of a frozen trainer anew, from the same wishes, with another strength (0: the nearest levels). What
 * adcgs_encode_stream() writes after it has the bytes that adcgs_encode_bytes() gave for that strength, as long as no training
 * comes between.
 */
adcgs_status adcgs_level_choose(adcgs_trainer *trainer, double strength, adcgs_error *error);

/** Give each group of channels the density that codes its rounded values in the fewest bits, and take note of these. */
void adcgs_level_densities(adcgs_trainer *trainer);

#endif
