/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The motion of splats over time in the form that matching of images gives (init/stereo.h): static points, moving points with
 * times, velocities and lifetimes, and rigid bodies. It is read from the splats instead of being found in images.
 */
#ifndef ADCGS_INIT_SPLATS_SPLAT_MOTION_H
#define ADCGS_INIT_SPLATS_SPLAT_MOTION_H

#include "init/stereo.h"

/** True for a scene of splats, over time or static; not if it has points of another source and static splats. */
int adcgs_splat_motion_applies(const adcgs_scene *scene);
/** Fills *out, which is zero, by the scene's splats. The caller clears it. */
adcgs_status adcgs_splat_motion_find(adcgs_stereo *out, const adcgs_scene *scene, const adcgs_stereo_options *options,
                                     adcgs_error *error);

#endif
