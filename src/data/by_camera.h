/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Views sorted by the camera that took them: cameras that stay where they are have many, those that move one each. */
#ifndef ADCGS_DATA_BY_CAMERA_H
#define ADCGS_DATA_BY_CAMERA_H

#include "data/scene.h"

/** 0 for cameras of equal size, lens and pose, to the last bit; else an order of some kind. */
int adcgs_camera_compare(const adcgs_camera *a, const adcgs_camera *b);

/**
 * Views are of one camera if adcgs_camera_compare() finds them equal.
 * of: [n] the camera of each view; cameras are numbered from 0 in the order in which the views first show them.
 * order: [n] indices of the views, camera by camera, each in ascending time (of equal times in ascending index); may be NULL.
 * *n_cameras: how many there are; 0 for no views.
 */
adcgs_status adcgs_sort_by_camera(const adcgs_scene_view *views, uint32_t n, uint32_t *of, uint32_t *order, uint32_t *n_cameras,
                                  adcgs_error *error);

#endif
