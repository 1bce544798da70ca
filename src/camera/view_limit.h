/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The region that was filmed, as far as the stored cameras show it: poses near to one of theirs. Outside of it an image shows
 * places that no camera saw. Each axis has a measure of its own: cameras far apart on a circle allow no step below the circle.
 */
#ifndef ADCGS_CAMERA_VIEW_LIMIT_H
#define ADCGS_CAMERA_VIEW_LIMIT_H

#include "camera/follow.h"

typedef struct adcgs_view_limit {
    int n;              /**< poses; 0: nothing is known, and there is no limit */
    double (*pose)[12]; /**< [n] camera to world */
    double up[3];       /**< of length 1; 0 if it is not known, and then all directions aside are equal */
    double spacing[2];  /**< typical distance of neighbouring cameras [world units]: level, upwards */
    double distance;    /**< from the first view to its pivot [world units] */
    double radius[2]; /**< of the region around a pose [world units]: level, upwards; along the view the distance alone counts */
    double lowest;    /**< smallest height of a pose along up [world units] */
    double flattest;  /**< smallest angle by which a pose looks down [radians] */
    double below;     /**< share of the usual tolerances that remains below both, 0 to 1 */
} adcgs_view_limit;

/**
 * The region of n stored cameras and of the path, which may be NULL. up: NULL if it is not known. distance: from the first view
 * to its pivot [world units]. ADCGS_ERR_MEMORY is the only failure.
 */
adcgs_status adcgs_view_limit_init(adcgs_view_limit *limit, const adcgs_filmed_camera *cameras, int n, const adcgs_follow *follow,
                                   const double up[3], double distance, adcgs_error *error);
void adcgs_view_limit_clear(adcgs_view_limit *limit);
/** Sets another distance. */
void adcgs_view_limit_scale(adcgs_view_limit *limit, double distance);
/** At most 1 inside the region, 2 at twice the tolerance of an axis. */
double adcgs_view_limit_at(const adcgs_view_limit *limit, const double pose[12]);

#endif
