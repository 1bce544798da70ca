/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sparse models of COLMAP: cameras, images and points3D, .bin or .txt, in sparse/N, in sparse or in the folder itself. As in
 * adcgs, pixel centres lie at 0.5. Axes are OpenCV's. Images lie in images/, in the folder itself, in input/, or reduced in
 * images_N/; for models next to HyperNeRF's files, in rgb/Nx/.
 *
 * - With images the scene has a single time, regardless of their content: a model has no timestamps. Of the images sorted by
 *   name every 8th (0, 8, 16, ...) is for testing.
 * - With a video for each image, videos/NAME.mp4, videos/STEM.mp4 or STEM.mp4, the images are fixed cameras. STEM is NAME
 *   without its extension; .mkv, .mov and .webm are also accepted. The first camera by name is for testing, the others are for
 *   training.
 *
 * Masks lie in masks/ under the names of the images, with ".png" appended as COLMAP expects them, or with the extension replaced.
 *
 * The model's points become the scene's points, with their colours. If tracks are available, points seen by fewer than two
 * training images are left out.
 */
#ifndef ADCGS_SCENE_LAYOUTS_COLMAP_H
#define ADCGS_SCENE_LAYOUTS_COLMAP_H

#include "scene/scene.h"

/** True if any file of a model exists. */
int adcgs_is_colmap(const char *folder);

/**
 * Fills an empty scene from its directory, with times in [0,1].
 * \return ADCGS_ERR_UNSUPPORTED, naming the kind, for cameras other than pinholes with OpenCV's distortion; ADCGS_ERR_DATA,
 * naming the file, for missing or invalid data
 */
adcgs_status adcgs_colmap_read(adcgs_scene *scene, const adcgs_frame_range *frames, int with_points, adcgs_error *error);

/**
 * Reads only the points of a model, if the scene's directory has one. Every period-th of its images by name is for testing,
 * beginning with the first. If the list of images is missing, there are n, with ids from 1 in the order of their names.
 */
adcgs_status adcgs_colmap_read_points(adcgs_scene *scene, size_t n, size_t period, adcgs_error *error);

#endif
