/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Values of images in fewer bytes: 16 bits, or 8 where no bit of these is lost. */
#ifndef ADCGS_SCENE_IMAGE_VALUES_H
#define ADCGS_SCENE_IMAGE_VALUES_H

#include "base/base.h"

/**
 * Stores values in the fewest bytes, in place: binary32 if one is outside [0,1], else 16 bits, or 8 bits without a loss to the
 * 16. \return bytes of a value
 */
uint8_t adcgs_values_narrow(float *values, size_t n);
/** The inverse, for n values that are put `step` apart; 8 bits yield the same floats as 16. */
void adcgs_values_widen(float *to, size_t step, const void *values, int bytes, size_t n);
/** A value as it comes back from 16 bits; clipped to [0,1]. */
float adcgs_value_round(float value);

#endif
