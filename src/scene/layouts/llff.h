/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The layouts of LLFF and Neu3D: a folder with poses_bounds.npy, a table of 17 numbers for each image or camera, in the order
 * of their names. 15 of them are a 3x5 matrix: the camera's down, right and backward axes in the world, its position, and
 * height, width and focal length in pixels. Two are the distances of the nearest and the farthest point.
 *
 * - LLFF: images/, or else the images_N/ of the largest images. All have one time; every 8th (0, 8, 16, ...) is for testing.
 * - Neu3D: camNN.mp4 (or another video), or camNN/images/ or camNN/ with an image for each frame. The first camera is for
 *   testing, the others are for training; all have the same number of frames.
 *
 * Height, width and focal length are often those of larger images; they are scaled to the available images. Points come from
 * points3d.ply, or from a COLMAP model in the same folder, which is in the same world.
 */
#ifndef ADCGS_SCENE_LAYOUTS_LLFF_H
#define ADCGS_SCENE_LAYOUTS_LLFF_H

#include "scene/scene.h"

/** True if poses_bounds.npy exists. */
int adcgs_is_llff(const char *folder);

/**
 * Fills an empty scene from its directory, with times in [0,1].
 * \return ADCGS_ERR_DATA, naming file and row, for invalid data, and if the number of poses differs from that of images or
 * cameras
 */
adcgs_status adcgs_llff_read(adcgs_scene *scene, const adcgs_frame_range *frames, int with_points, adcgs_error *error);

#endif
