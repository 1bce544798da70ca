/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The layout of HyperNeRF and Nerfies: a folder with
 * - dataset.json: train_ids and val_ids. If val_ids is empty: ids, of which 0, 4, 8, ... are for training and 2, 6, 10, ... for
 *   testing;
 * - metadata.json: for each id a warp_id, its frame number; the largest of all is the end of the scene;
 * - scene.json: center and scale, which convert cameras and points to working coordinates (x - center) * scale;
 * - camera/ID.json: cameras in OpenCV axes with world-to-camera rotations, for images at full size, with skew and OpenCV's
 *   distortion (k1 k2 k3, p1 p2); the images are undistorted when they are loaded;
 * - rgb/Nx/ID.png: images at 1/N of full size; the largest are used;
 * - points.npy, optional: points in the coordinates of the camera files.
 */
#ifndef ADCGS_SCENE_LAYOUTS_HYPERNERF_H
#define ADCGS_SCENE_LAYOUTS_HYPERNERF_H

#include "scene/scene.h"

/** True if a folder has this layout: dataset.json, metadata.json and camera/ exist. */
int adcgs_is_hypernerf(const char *folder);

/**
 * Fills the views of an empty scene from its directory, with times in [0,1], and its axes; with_points: also its points.
 * val_ids become the test split.
 * \return ADCGS_ERR_DATA, naming file and field, for invalid data
 */
adcgs_status adcgs_hypernerf_read(adcgs_scene *scene, int with_points, adcgs_error *error);

#endif
