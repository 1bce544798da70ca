/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A file of splats (media/splats/splats.h) as a static scene, or splats over time (media/dynamic/dynamic_splats.h) as a dynamic
 * one. The views are rendered from the splats by our own renderer, each time that a view is loaded. They are pinholes of 400x400
 * pixels on two spheres around the splats, spread evenly over each, that look at the centre. The outer sphere's images show all
 * splats except the outermost twentieth; the inner sphere's images show a part of them, larger. Splats that do not look like an
 * object are seen from the directions that suit them (splat_aims.h).
 */
#ifndef ADCGS_SCENE_LAYOUTS_SPLAT_FILE_H
#define ADCGS_SCENE_LAYOUTS_SPLAT_FILE_H

#include "media/dynamic/dynamic_splats.h"
#include "scene/scene.h"

#define ADCGS_SPLAT_SCENE_SIZE 400 /**< pixels, width and height of the views; chosen by hand, not measured */

/**
 * Fills the scene and scene->splats, without near planes. Static splats: 100 views for training, 10 for validation, 20 for
 * testing. Splats over time: 4 to 32 views of each frame for training, 640 in all if possible; 2 fixed cameras for validation
 * and 6 for testing, at 8 times. With want_points the centres of static splats with opacity 0.1 and more become initial
 * points. The world's axes are known if the format gives them. options: for splats over time; NULL for the defaults.
 */
adcgs_status adcgs_splat_scene_read(adcgs_scene *scene, int want_points, const adcgs_dynamic_options *options, const char *path,
                                    adcgs_error *error);

#endif
