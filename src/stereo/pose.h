/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Poses of bodies at any time, and where their points are at rest. */
#ifndef ADCGS_STEREO_POSE_H
#define ADCGS_STEREO_POSE_H

#include "stereo/stereo.h"

/** Pose of a body, from 0, at t in [0,1]: between the moments that were matched, or that of the nearest. */
adcgs_stereo_pose adcgs_stereo_pose_at(const adcgs_stereo *stereo, uint32_t body, float t);

/** Where a point is while its body is at rest; if it has none, in the middle of its life. */
void adcgs_stereo_rest(const adcgs_stereo *stereo, const adcgs_stereo_point *point, double x[3]);

#endif
