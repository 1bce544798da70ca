/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Views sorted by camera. A fixed camera has many views; a moving camera counts as one camera for each pose. */
#ifndef ADCGS_SCENE_GROUP_VIEWS_H
#define ADCGS_SCENE_GROUP_VIEWS_H

#include "scene/scene.h"

/** Returns 0 for cameras of equal size, lens and pose, to the last bit; otherwise the sign in an arbitrary total order. */
int adcgs_camera_compare(const adcgs_camera *a, const adcgs_camera *b);

/**
 * Two views are of one camera if adcgs_camera_compare() finds their cameras equal.
 * of: [n] the camera of each view. Cameras are numbered from 0, in the order of their first views.
 * order: [n] indices of the views, camera by camera, each in ascending time (for equal times in ascending index); may be NULL.
 * *n_cameras: the number of cameras; 0 without views.
 */
adcgs_status adcgs_group_views(const adcgs_scene_view *views, uint32_t n, uint32_t *of, uint32_t *order, uint32_t *n_cameras,
                               adcgs_error *error);

#endif
