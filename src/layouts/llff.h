/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The layouts of LLFF and Neu3D: a folder with poses_bounds.npy, a table of 17 numbers for each picture or camera, in the order
 * of their names. 15 are a 3x5 matrix: the columns are the camera's down, right and backward axes in the world, its position,
 * and height, width and focal length in pixels; two are the distances of the nearest and the farthest point.
 *
 * - LLFF: images/, or else the images_N/ of the largest pictures. All of one moment; every 8th (0, 8, 16, ...) is for testing.
 * - Neu3D: camNN.mp4 (or another video), or camNN/images/ or camNN/ with a picture for each frame. The first camera is for
 *   testing, the others are for training; all have the same number of frames.
 *
 * Height, width and focal length are often those of larger pictures: they are made to fit those that are there. Points are those
 * of points3d.ply, or of a COLMAP model beside, which is in the same world.
 */
#ifndef ADCGS_LAYOUTS_LLFF_H
#define ADCGS_LAYOUTS_LLFF_H

#include "data/scene.h"

/** Is poses_bounds.npy there? */
int adcgs_is_llff(const char *folder);

/**
 * Fill an empty scene from its directory, with times in [0,1].
 * \return ADCGS_ERR_DATA, naming file and row, for what is wrong, and if there are not as many poses as pictures or cameras.
 */
adcgs_status adcgs_llff_read(adcgs_scene *scene, const adcgs_frame_range *frames, int with_points, adcgs_error *error);

#endif
