/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The region that was filmed, as far as the stored cameras show it: poses near to one of theirs. Outside of it an image shows
 * places that no camera saw.
 */
#ifndef ADCGS_CAMERA_VIEW_LIMIT_H
#define ADCGS_CAMERA_VIEW_LIMIT_H

#include "camera/follow.h"

typedef struct adcgs_view_limit {
    int n;              /**< poses; 0: nothing is known, and there is no limit */
    double (*pose)[12]; /**< [n] camera to world */
    double spacing;     /**< typical distance of neighbouring cameras [world units] */
    double radius;      /**< of the region around a pose [world units] */
} adcgs_view_limit;

/**
 * The region of n stored cameras and of the path, which may be NULL. distance: from the first view to its pivot [world units].
 * ADCGS_ERR_MEMORY is the only failure.
 */
adcgs_status adcgs_view_limit_init(adcgs_view_limit *limit, const adcgs_filmed_camera *cameras, int n, const adcgs_follow *follow,
                                   double distance, adcgs_error *error);
void adcgs_view_limit_clear(adcgs_view_limit *limit);
/** Sets another distance. */
void adcgs_view_limit_scale(adcgs_view_limit *limit, double distance);
/** At most 1 inside the region, 2 at twice its radius or angle. */
double adcgs_view_limit_at(const adcgs_view_limit *limit, const double pose[12]);

#endif
