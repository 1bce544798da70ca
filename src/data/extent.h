/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How long a length is in a scene of unknown units: all is measured by it, and nothing in absolute units. */
#ifndef ADCGS_DATA_EXTENT_H
#define ADCGS_DATA_EXTENT_H

#include "data/scene.h"

/** Of a scene's extent: what is less is rounding. */
#define ADCGS_EXTENT_NOTHING 1e-9

/**
 * About how far things are from the training cameras, by the scene's points, the near bound or how far the cameras are apart,
 * whichever is the first to be there; 1 if nothing in the scene has a length. It scales with the scene.
 */
adcgs_status adcgs_scene_extent(const adcgs_scene *scene, double *extent, adcgs_error *error);

#endif
