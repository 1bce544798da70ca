/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The first anchors (paper section 3.2). */
#ifndef ADCGS_TRAIN_INITIALISE_H
#define ADCGS_TRAIN_INITIALISE_H

#include "init/stereo.h"
#include "scene/scene.h"
#include "train/schedule.h"

/**
 * Creates the first anchors, one per voxel, at the points of start_points.h. found: result of matching, or nothing. With
 * lifetimes enabled, anchors of moving points live around their frame, and anchors of static points do not move.
 */
adcgs_status adcgs_initialise(adcgs_fmodel **out, const adcgs_scene *scene, const adcgs_train_config *config,
                              const adcgs_stereo *found, adcgs_error *error);
/** Sets the poses of bodies as tracked; poses of other bodies are unchanged. */
void adcgs_set_poses(adcgs_fmodel *f, const adcgs_stereo *found);
/** Sets an anchor's lifetime, p->life to each side of p->t + p->shift, and its velocity, for a point p. */
void adcgs_set_lifetime(adcgs_fmodel *f, uint32_t anchor, const adcgs_stereo_point *point);

#endif
