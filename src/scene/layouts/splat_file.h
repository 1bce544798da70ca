/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A file of splats (media/splats/splats.h) as a static scene. Its views are rendered from the splats by our own renderer, each
 * time that a view is loaded. They are pinholes of 400x400 pixels on two spheres around the splats, spread evenly over each,
 * that look at the centre. The outer sphere's images show all splats except the outermost twentieth; the inner sphere's images
 * show a part of them, larger.
 */
#ifndef ADCGS_SCENE_LAYOUTS_SPLAT_FILE_H
#define ADCGS_SCENE_LAYOUTS_SPLAT_FILE_H

#include "scene/scene.h"

#define ADCGS_SPLAT_SCENE_SIZE 400 /**< pixels, width and height of the views; chosen by hand, not measured */

/**
 * Fills the scene: 100 views for training, 10 for validation, 20 for testing, without near planes, and scene->splats. With
 * want_points the centres of splats with opacity 0.1 and more become initial points. The world's axes are known if the format
 * gives them.
 */
adcgs_status adcgs_splat_scene_read(adcgs_scene *scene, int want_points, const char *path, adcgs_error *error);

#endif
