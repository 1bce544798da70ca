/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A PLY of splats as a still scene. Its views are what our own renderer shows
 * of the splats, drawn anew whenever one is loaded: pinholes of 400x400 pixels
 * on two spheres round the splats, spread evenly over each, that look at their
 * centre. From the outer sphere all but the outermost twentieth of the splats
 * is in the picture, from the inner one part of it is, larger.
 */
#ifndef ADCGS_DATA_SPLAT_SCENE_H
#define ADCGS_DATA_SPLAT_SCENE_H

#include "data/scene.h"

#define ADCGS_SPLAT_SCENE_SIZE 400 /**< width and height of the views */
#define ADCGS_SPLAT_SCENE_FILTER 0.3f /**< pixels^2 added to projected splats, as they are trained and shown elsewhere */

/** Whether the file begins as a PLY file does. */
int adcgs_is_ply(const char *path);

/**
 * Fill the scene: 100 views for training, 10 for validation, 20 for testing, without near planes; scene->splats; and with
 * want_points the centres of the splats as initial points, those of opacity 0.1 and more. The world's axes stay unknown: such
 * files do not tell.
 */
adcgs_status adcgs_splat_scene_read(adcgs_scene *scene, int want_points, const char *path, adcgs_error *error);
void adcgs_splat_scene_free(adcgs_splat_scene **splats);

/**
 * What a camera sees over a background, values clipped to [0,1], three channels. Colours are those for the direction of view,
 * and not below 0. Any thread may call; path is for messages.
 */
adcgs_status adcgs_splat_scene_render(const adcgs_splat_scene *splats, const float background[3], const adcgs_camera *camera,
                                      adcgs_image *out, const char *path, adcgs_error *error);

#endif
