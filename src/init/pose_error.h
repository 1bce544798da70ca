/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pose errors measured from images alone, before training. */
#ifndef ADCGS_INIT_POSE_ERROR_H
#define ADCGS_INIT_POSE_ERROR_H

#include "init/rig.h"

/** Compares each camera with the two nearest cameras of similar viewing direction. Leaves out->pixels unchanged. */
adcgs_status adcgs_stereo_measure_pose_error(const adcgs_stereo_rig *rig, adcgs_stereo_pose_error *out, adcgs_pool *pool,
                                             adcgs_error *error);

#endif
