/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Poses of rigid bodies at any time, and the rest positions of their points. */
#ifndef ADCGS_INIT_RIGID_BODY_POSE_H
#define ADCGS_INIT_RIGID_BODY_POSE_H

#include "init/rigid/rigid.h"
#include "init/stereo.h"

/** Sets a pose to a motion, expressed relative to a pivot. */
void adcgs_stereo_pose_set(adcgs_stereo_pose *pose, const adcgs_rigid *motion, const double pivot[3]);
/** Changes signs of quaternions so that each pose is close to the one before. */
void adcgs_stereo_poses_align(adcgs_stereo_pose *poses, uint32_t n);
/** Pose of a body, counted from 0, at t in [0,1]: interpolated between matched frames, constant beyond the first and last. */
adcgs_stereo_pose adcgs_stereo_pose_at(const adcgs_stereo *stereo, uint32_t body, float t);

/** Position of a point in its body's rest pose; without a body, in the middle of its lifetime. */
void adcgs_stereo_rest(const adcgs_stereo *stereo, const adcgs_stereo_point *point, double x[3]);

#endif
