/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The layout of Dynamic 3D Gaussians' Panoptic benchmark: train_meta.json and test_meta.json with, for each timestamp and each
 * camera, the image (fn, below ims/), K (k) and the matrix from world to camera (w2c) in OpenCV's axes; w and h for all. The
 * files say which cameras are for training. Timestamps are evenly spaced numbers of frames. An image in seg/ of the same name,
 * with .png for .jpg, has 0 in the static background. init_pt_cld.npz holds points of the first timestamp, an array `data` of
 * rows x, y, z, r, g, b, seg.
 */
#ifndef ADCGS_LAYOUTS_PANOPTIC_H
#define ADCGS_LAYOUTS_PANOPTIC_H

#include "data/scene.h"

int adcgs_is_panoptic(const char *folder);
/** Fill an empty scene from its directory, with times in [0,1]. ADCGS_ERR_DATA, naming file and place. */
adcgs_status adcgs_panoptic_read(adcgs_scene *scene, int with_points, adcgs_error *error);

#endif
