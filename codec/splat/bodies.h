/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where rigid bodies are at a time (spec clause "Rigid bodies"): once a frame for each, and for the lanes of a group. */
#ifndef ADCGS_SPLAT_BODIES_H
#define ADCGS_SPLAT_BODIES_H

#include "splat/splat_isa.h"

/** A body's pose: what it takes along turns about its centre, which goes to place. */
typedef struct adcgs_body_pose {
    float q[4], matrix[9], centre[3], place[3];
} adcgs_body_pose;

/** The centres of a model's bodies; 0 of those that no anchor has. */
void adcgs_bodies_init(adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_model *model);
/** The rest of their poses, from a row of Z or what lies between two. */
void adcgs_bodies_at(adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_params *params, const float *row);
/** Those of 64 anchors from first on; without one, and past the last anchor, the first body's. 0: none has a body. */
int adcgs_bodies_gather(adcgs_body_lanes *lanes, const adcgs_body_pose pose[ADCGS_BODIES_MAX], const adcgs_model *model,
                        uint32_t first);

#endif
