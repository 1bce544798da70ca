/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Poses of rigid bodies at a time (spec clause "Rigid bodies"): once per frame and body, and for the lanes of a group. */
#ifndef ADCGS_SPLAT_RIGID_MOTION_H
#define ADCGS_SPLAT_RIGID_MOTION_H

#include "splat/splat_isa.h"

/** A body's pose: its anchors turn about centre, which moves to place. */
typedef struct adcgs_body_pose {
    float q[4], matrix[9], centre[3], place[3];
} adcgs_body_pose;

/** Set the centres of a model's bodies; 0 for bodies without anchors. */
void adcgs_bodies_init(adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_model *model);
/** Set the other members of the poses, from a row of Z or an interpolation of rows. */
void adcgs_bodies_at(adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_params *params, const float *row);
/** Gather the poses of 64 anchors from first on. Lanes without a body get the first body's pose. Returns 0 if all lack one. */
int adcgs_bodies_gather(adcgs_body_lanes *lanes, const adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_model *model,
                        uint32_t first);

#endif
