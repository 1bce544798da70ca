/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Black levels of cameras. What a sensor, or light that strays in a lens, adds to all of a picture differs between cameras by
 * several of 255 levels. Filmed in the dark, that is as much as what there is to see, no gain makes up for it, and a model told
 * to match all cameras puts haze before those that are bright.
 */
#ifndef ADCGS_TRAIN_BLACK_LEVEL_H
#define ADCGS_TRAIN_BLACK_LEVEL_H

#include "train/state.h"

/**
 * What each camera of trainer->exposure adds, from the training pictures that are loaded: where all of them see black, which is
 * where the darkest fifth of what each takes lies within a few levels, the mean of that fifth, less that of the middle camera.
 * Elsewhere, and where a camera's brightness is taken as it is, 0: what is dark but not alike says nothing of a camera.
 */
adcgs_status adcgs_black_levels(adcgs_trainer *trainer, adcgs_error *error);

#endif
