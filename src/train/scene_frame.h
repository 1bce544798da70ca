/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Coordinate system of the scene. */
#ifndef ADCGS_TRAIN_SCENE_FRAME_H
#define ADCGS_TRAIN_SCENE_FRAME_H

#include "scene/scene.h"

/**
 * Scene units: the origin is the focus of the training cameras, and their median distance from it is 1. The focus is the point
 * nearest to all optical axes. It must lie in front of most cameras, at about the depth of the points that they see. The axes of
 * a camera that sweeps and looks outwards meet behind it. Then the focus is the median of points on the cameras' axes, each at
 * the median depth of the scene's points in view. Without points the focus lies in front of the mean camera, at
 * adcgs_scene_extent().
 */
adcgs_status adcgs_scene_frame(const adcgs_scene *scene, double origin[3], double *scale, adcgs_error *error);

#endif
