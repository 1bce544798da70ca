/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The path of a moving camera that filmed the scene: a few of its poses, from which a spline gives the others (camera/spline.h).
 * Poses are added where the spline deviates most, as Ramer (1972) and Douglas and Peucker (1973) simplify polygons.
 */
#ifndef ADCGS_ENCODE_FILMED_PATH_H
#define ADCGS_ENCODE_FILMED_PATH_H

#include "camera/path.h"
#include "scene/scene.h"

typedef struct adcgs_filmed_path {
    int n;                  /**< keys; 0: the poses do not lie on a smooth path */
    adcgs_camera_key *keys; /**< [n] in ascending time, which `at` repeats; poses are exact in binary32; NULL if n is 0 */
} adcgs_filmed_path;

/** views: [n] of one camera, in ascending time without equal times. scale: world units per scene unit. */
adcgs_status adcgs_filmed_path_make(adcgs_filmed_path *path, const adcgs_scene_view *views, uint32_t n, double scale,
                                    adcgs_error *error);
void adcgs_filmed_path_clear(adcgs_filmed_path *path);

#endif
