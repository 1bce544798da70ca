/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Brightness of the training images, which bounds the gains found in training. A gain follows the model, and the model follows
 * the gain. Without a bound from the images alone, both can drift together.
 */
#ifndef ADCGS_TRAIN_EXPOSURE_BRIGHTNESS_H
#define ADCGS_TRAIN_EXPOSURE_BRIGHTNESS_H

#include "train/state/state.h"

/**
 * Bounds the gains of trainer->exposure by the mean brightness of each camera's loaded images. Masked and burnt pixels do not
 * count, nor does the background of images with alpha. Without gains (config.gains) the bound is 0.
 */
adcgs_status adcgs_bound_gains(adcgs_trainer *trainer, adcgs_error *error);

#endif
