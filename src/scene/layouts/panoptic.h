/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The layout of Dynamic 3D Gaussians' Panoptic benchmark: train_meta.json and test_meta.json. For each timestamp and each
 * camera they hold the image (fn, below ims/), K (k) and the world-to-camera matrix (w2c) in OpenCV's axes; w and h are for
 * all. The files determine the training cameras. Timestamps are evenly spaced frame numbers. An image in seg/ of the same name,
 * with .png for .jpg, is 0 in the static background. init_pt_cld.npz holds points of the first timestamp, an array `data` of
 * rows x, y, z, r, g, b, seg.
 */
#ifndef ADCGS_SCENE_LAYOUTS_PANOPTIC_H
#define ADCGS_SCENE_LAYOUTS_PANOPTIC_H

#include "scene/scene.h"

int adcgs_is_panoptic(const char *folder);
/** Fills an empty scene from its directory, with times in [0,1]. ADCGS_ERR_DATA, naming file and position in it. */
adcgs_status adcgs_panoptic_read(adcgs_scene *scene, int with_points, adcgs_error *error);

#endif
