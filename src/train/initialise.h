/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Where training starts: the scene's frame of reference and the first anchors (paper section 3.2). */
#ifndef ADCGS_TRAIN_INITIALISE_H
#define ADCGS_TRAIN_INITIALISE_H

#include "data/scene.h"
#include "train/schedule.h"

/** Fewer points say nothing of a scene. */
enum { ADCGS_POINTS_LEAST = 16 };

/** Scene units: the cameras' common focus is the origin, their median distance from it is 1. */
adcgs_status adcgs_scene_frame(const adcgs_scene *scene, double origin[3], double *scale, adcgs_error *error);

/**
 * First anchors: the scene's points, or random points inside the cameras' common volume; one per voxel, at most
 * config->start_anchors. Only training views are looked at.
 */
adcgs_status adcgs_initialise(adcgs_fmodel **out, const adcgs_scene *scene, const adcgs_train_config *config,
                               adcgs_error *error);

#endif
