/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The layout of HyperNeRF and Nerfies: a folder with
 * - dataset.json: train_ids and val_ids, or, where val_ids is empty, ids, of which 0, 4, 8, ... are for training and 2, 6, 10,
 *   ... for testing;
 * - metadata.json: a warp_id for each id, the number of its moment; the largest of all is the end of the scene;
 * - scene.json: center and scale, which take cameras and points to working coordinates (x - center) * scale;
 * - camera/ID.json: cameras in OpenCV axes with world-to-camera rotations, for pictures at full size, with skew and OpenCV's
 *   distortion (k1 k2 k3, p1 p2): the pictures are straightened when they are loaded;
 * - rgb/Nx/ID.png: pictures at 1/N of full size; the largest are taken;
 * - points.npy, which may be missing: points in the coordinates of the cameras' files.
 */
#ifndef ADCGS_LAYOUTS_HYPERNERF_H
#define ADCGS_LAYOUTS_HYPERNERF_H

#include "data/scene.h"

/** Is it such a folder: are dataset.json, metadata.json and camera/ there? */
int adcgs_is_hypernerf(const char *folder);

/**
 * Fill the views of an empty scene from its directory, with times in [0,1], and its axes; with_points: its points too. val_ids
 * become the test split.
 * \return ADCGS_ERR_DATA, naming file and field, for what is wrong.
 */
adcgs_status adcgs_hypernerf_read(adcgs_scene *scene, int with_points, adcgs_error *error);

#endif
