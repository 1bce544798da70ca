/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The extent of a scene in unknown units. All lengths are measured relative to it, never in absolute units. */
#ifndef ADCGS_SCENE_EXTENT_H
#define ADCGS_SCENE_EXTENT_H

#include "scene/scene.h"

/**
 * Share of a scene's extent below which a length is a rounding error; ratio, arithmetic: far above binary64's 1e-16, far below
 * any capture.
 */
#define ADCGS_EXTENT_NOTHING 1e-9

/**
 * Sets *extent to the approximate distance of the scene's content from the training cameras. The first available source
 * decides: the points, the near bound, the distances between cameras. Without any length in the scene the extent is 1. It
 * scales with the scene.
 */
adcgs_status adcgs_scene_extent(const adcgs_scene *scene, double *extent, adcgs_error *error);

#endif
