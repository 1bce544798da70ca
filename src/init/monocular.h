/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Moving content in front of a moving camera. Static depths are matched between images as if all were taken at once. They predict
 * the image without motion; pixels that differ from it show moving content. A single camera cannot measure the depth of moving
 * content. Objects stand on surfaces, so each moving part gets the depth of the surface below its lower edge (Hoiem, Efros and
 * Hebert 2006, Putting objects in perspective, CVPR).
 */
#ifndef ADCGS_INIT_MONOCULAR_H
#define ADCGS_INIT_MONOCULAR_H

#include "init/fuse.h"

/** Sets the background of each camera: the colours of the other cameras at the static depths. */
adcgs_status adcgs_monocular_set_background(adcgs_stereo_rig *rig, const adcgs_depths *depths, adcgs_pool *pool,
                                            adcgs_error *error);

/** Adds the moving points of frame m. */
adcgs_status adcgs_monocular_find_moving(adcgs_stereo_list *list, const adcgs_stereo_rig *rig, const adcgs_depths *depths, int m,
                                         adcgs_error *error);

/**
 * Replaces the velocity of each moving point by the median of the velocities nearby, in its frame and the two adjacent ones.
 * Points ascend in t. A single match is off by about one pixel, which adds up over a lifetime.
 */
adcgs_status adcgs_monocular_smooth_velocities(adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig,
                                               adcgs_error *error);

#endif
