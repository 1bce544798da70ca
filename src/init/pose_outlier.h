/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Detection of single cameras with a wrong pose. The points known from other cameras lie elsewhere in the image of such a camera.
 * A good fit to another pose separates it from cameras that only see little of the scene.
 */
#ifndef ADCGS_INIT_POSE_OUTLIER_H
#define ADCGS_INIT_POSE_OUTLIER_H

#include "init/rig.h"
#include "init/smooth.h"

/** depths: static depths of the rig's cameras that have a background, in order. Sets out->outlier and out->n_outliers. */
adcgs_status adcgs_stereo_find_pose_outliers(adcgs_stereo *out, const adcgs_stereo_rig *rig, const adcgs_depths *depths,
                                             adcgs_pool *pool, adcgs_error *error);

#endif
