/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Contrast of a scene. Image errors are absolute, so one lambda would code dark scenes coarsely and bright scenes finely. Unless
 * the user sets lambda, it follows the contrast of the images.
 */
#ifndef ADCGS_TRAIN_EXPOSURE_CONTRAST_H
#define ADCGS_TRAIN_EXPOSURE_CONTRAST_H

#include "train/state/state.h"

/**
 * Standard deviation of the training images' values at which the presets' lambda applies unchanged; values of 0 to 1, calibrated
 * on six scenes (doc/log/rate.md, "Lambda follows the contrast").
 */
#define ADCGS_CONTRAST_NOMINAL 0.22

/**
 * RMS over the channels of the standard deviation, from up to 64 loaded training images, evenly chosen. Masked pixels do not
 * count; 0 if all pixels are masked.
 */
adcgs_status adcgs_contrast(const adcgs_trainer *t, double *contrast, adcgs_error *error);

/**
 * Sets lambda to the user's value or, without one, to the preset's times the relative contrast. The first call of a run measures
 * the contrast, which then stays.
 */
adcgs_status adcgs_contrast_lambda(adcgs_trainer *t, adcgs_error *error);
/** Records the lambda that a restored run began with, from its stored contrast, and leaves the run's lambda. */
void adcgs_contrast_record(adcgs_trainer *t);

#endif
