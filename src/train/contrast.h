/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Contrast of a scene. Errors of pictures are absolute, so one lambda would code what was filmed in the dark coarsely, and in
 * glaring light finely. Where none is asked for, it follows how much the pictures vary.
 */
#ifndef ADCGS_TRAIN_CONTRAST_H
#define ADCGS_TRAIN_CONTRAST_H

#include "train/state.h"

/** Standard deviation of the training pictures' values at which the presets' lambda holds as it is. */
#define ADCGS_CONTRAST_NOMINAL 0.22

/**
 * Of up to 64 of the training pictures that are loaded, evenly chosen, about their mean, the mean square of the channels. What is
 * behind masks has no part in it; 0 where all is.
 */
adcgs_status adcgs_contrast(const adcgs_trainer *t, double *contrast, adcgs_error *error);

/**
 * Begin with the lambda that was asked for, or else with the preset's times the contrast, relative to the nominal one. The
 * contrast is measured by the first call of a run, and stays.
 */
adcgs_status adcgs_contrast_lambda(adcgs_trainer *t, adcgs_error *error);

#endif
