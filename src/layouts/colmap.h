/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sparse models of COLMAP: cameras, images and points3D, .bin or .txt, in sparse/N, in sparse or in the folder itself. Pixel
 * centres lie at 0.5, as ours do, and axes are OpenCV's. Pictures lie in images/, in the folder itself, in input/, or reduced
 * in images_N/, and for models that lie beside HyperNeRF's files in rgb/Nx/.
 *
 * - With pictures the scene has one moment, whatever the pictures show: a model knows of no time. Of the images sorted by name
 *   every 8th (0, 8, 16, ...) is for testing.
 * - With a video for each image, videos/NAME.mp4, videos/STEM.mp4 or STEM.mp4 (STEM is NAME without its extension; .mkv, .mov
 *   and .webm do as well), the images are fixed cameras. The first by name is for testing, the others are for training.
 *
 * Masks lie in masks/ under the names of the pictures, with ".png" behind them, as COLMAP takes them, or without their own end.
 *
 * The model's points are the scene's, with their colours; where tracks are there, those that fewer than two images for training
 * have seen are left out.
 */
#ifndef ADCGS_LAYOUTS_COLMAP_H
#define ADCGS_LAYOUTS_COLMAP_H

#include "data/scene.h"

/** Is any file of a model there? */
int adcgs_is_colmap(const char *folder);

/**
 * Fill an empty scene from its directory, with times in [0,1].
 * \return ADCGS_ERR_UNSUPPORTED, naming the kind, for cameras that are no pinholes with OpenCV's distortion; ADCGS_ERR_DATA,
 * naming the file, for what is missing or wrong.
 */
adcgs_status adcgs_colmap_read(adcgs_scene *scene, const adcgs_frame_range *frames, int with_points, adcgs_error *error);

/**
 * The points of a model alone, if the scene's directory has any. Of its images every period-th by name is for testing, beginning
 * with the first; if the list of them is missing, there are n, with ids from 1 in the order of their names.
 */
adcgs_status adcgs_colmap_read_points(adcgs_scene *scene, size_t n, size_t period, adcgs_error *error);

#endif
