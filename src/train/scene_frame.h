/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene's frame of reference. */
#ifndef ADCGS_TRAIN_SCENE_FRAME_H
#define ADCGS_TRAIN_SCENE_FRAME_H

#include "data/scene.h"

/** Scene units: the cameras' common focus is the origin, their median distance from it is 1. */
adcgs_status adcgs_scene_frame(const adcgs_scene *scene, double origin[3], double *scale, adcgs_error *error);

#endif
