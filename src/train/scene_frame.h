/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene's frame of reference. */
#ifndef ADCGS_TRAIN_SCENE_FRAME_H
#define ADCGS_TRAIN_SCENE_FRAME_H

#include "data/scene.h"

/**
 * Scene units: the focus of the training cameras is the origin, their median distance from it is 1. The focus is the point
 * nearest to all optical axes, if most cameras have it in front, about as far as the points that they see. Axes of a camera that
 * sweeps and looks outwards meet behind it: there the focus is the middle of the points that the cameras look at, each at the
 * median depth of the scene's points in view. Without points it lies in front of the mean camera, at adcgs_scene_extent().
 */
adcgs_status adcgs_scene_frame(const adcgs_scene *scene, double origin[3], double *scale, adcgs_error *error);

#endif
