/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A file of splats (io/splats.h) as a still scene. Its views are what our own renderer shows
 * of the splats, drawn anew whenever one is loaded: pinholes of 400x400 pixels
 * on two spheres round the splats, spread evenly over each, that look at their
 * centre. From the outer sphere all but the outermost twentieth of the splats
 * is in the picture, from the inner one part of it is, larger.
 */
#ifndef ADCGS_LAYOUTS_SPLAT_FILE_H
#define ADCGS_LAYOUTS_SPLAT_FILE_H

#include "data/scene.h"

#define ADCGS_SPLAT_SCENE_SIZE 400 /**< width and height of the views */

/**
 * Fill the scene: 100 views for training, 10 for validation, 20 for testing, without near planes; scene->splats; and with
 * want_points the centres of the splats as initial points, those of opacity 0.1 and more. The world's axes are known if
 * the format tells.
 */
adcgs_status adcgs_splat_scene_read(adcgs_scene *scene, int want_points, const char *path, adcgs_error *error);

#endif
