/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Triangulation angles of a sparse model: for each point the largest angle between two of the images that see it, by which its
 * depth is known.
 */
#ifndef ADCGS_SCENE_LAYOUTS_COLMAP_ANGLES_H
#define ADCGS_SCENE_LAYOUTS_COLMAP_ANGLES_H

#include "base/base.h"

/** Position of an image in the world. */
typedef struct adcgs_colmap_centre {
    uint32_t id;
    double at[3];
} adcgs_colmap_centre;

typedef struct adcgs_colmap_angles {
    adcgs_colmap_centre *centre; /**< ascending ids; from malloc() */
    size_t n_centres;
    double (*ray)[3]; /**< directions from the current point to its images */
    size_t n_rays, ray_room;
    double *angle; /**< of the points so far, in degrees */
    size_t n, room;
    int failed; /**< out of memory */
} adcgs_colmap_angles;

/** Takes centre, from malloc(). */
void adcgs_colmap_angles_init(adcgs_colmap_angles *angles, adcgs_colmap_centre *centre, size_t n);
void adcgs_colmap_angles_clear(adcgs_colmap_angles *angles);
/** Adds an image of the current point's track; unknown images are ignored. */
void adcgs_colmap_angles_see(adcgs_colmap_angles *angles, const double point[3], uint32_t image);
/** Ends the current point. */
void adcgs_colmap_angles_end_point(adcgs_colmap_angles *angles);
/** Median of the points that two images see, in degrees; 0 if there is none. Changes the order of angle. */
double adcgs_colmap_angles_median(adcgs_colmap_angles *angles);

#endif
