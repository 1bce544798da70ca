/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Black levels of cameras. The sensor, or stray light in the lens, adds a constant to the whole image, which differs between
 * cameras by several of 255 levels. In dark scenes this offset is as large as the content, and no gain compensates for it. A
 * model that must match all cameras then puts haze in front of the brighter ones.
 */
#ifndef ADCGS_TRAIN_EXPOSURE_BLACK_LEVEL_H
#define ADCGS_TRAIN_EXPOSURE_BLACK_LEVEL_H

#include "train/state/state.h"

/**
 * Estimates the offset of each camera of trainer->exposure from the loaded training images. It applies only if all cameras see
 * black: the darkest fifth of each camera's pixels lies within a few levels. The offset is the mean of that fifth minus the
 * median over cameras. Otherwise all offsets are 0, because dark content of different brightness says nothing about a camera.
 * They are also 0 where a camera's brightness is used unchanged.
 */
adcgs_status adcgs_black_levels(adcgs_trainer *trainer, adcgs_error *error);

#endif
