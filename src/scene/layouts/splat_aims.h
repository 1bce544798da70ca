/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Directions from which splats look like the scene that they were made for. Objects look so from everywhere. A room or a
 * landscape shows large splats from directions where no camera was: the backs of walls, and the ground from below.
 */
#ifndef ADCGS_SCENE_LAYOUTS_SPLAT_AIMS_H
#define ADCGS_SCENE_LAYOUTS_SPLAT_AIMS_H

#include "scene/splat_views.h"

#define ADCGS_SPLAT_AIMS 96 /**< directions that are looked from; chosen by hand, not measured */

/** Selected directions, of unit length, from the centre to the camera; n 0: all. */
typedef struct adcgs_splat_aims {
    uint32_t n;
    double out[ADCGS_SPLAT_AIMS][3];
} adcgs_splat_aims;

/**
 * Looks at splats, in world units, from all around the scene's centre, and selects the directions with at least half as much
 * detail as the best one. *is_object: true if that holds for three quarters of them.
 */
adcgs_status adcgs_splat_aims_find(adcgs_splat_aims *aims, int *is_object, const adcgs_splat_scene *scene,
                                   const adcgs_splats *splats, const char *path, adcgs_error *error);

/** Direction i of a spiral of n directions of uniform density, of unit length. */
void adcgs_splat_aims_spread(double out[3], uint32_t i, uint32_t n, double angle);
/** Aims a camera at the centre. y points down in its image, or up if the splats' y axis is up. */
void adcgs_splat_aims_camera(adcgs_camera *camera, const adcgs_splat_scene *scene, const double out[3], double distance,
                             int size);
/** The distance at which a sphere of the scene's radius fills the image. */
double adcgs_splat_aims_distance(const adcgs_splat_scene *scene);

#endif
