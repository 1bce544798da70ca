/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The extent of a scene, its typical length. */
#include "config.h"

#include "scene/extent.h"

#include "system/sort_values.h"

#include <math.h>

#define POINTS_MOST 10000    /* largest number of points that are examined; chosen by hand, not measured */
#define BOUNDS_PER_EXTENT 4  /* extent / near bound; chosen by hand, not measured */
#define SPREADS_PER_EXTENT 4 /* extent / spread of the cameras; chosen by hand, not measured */

static void camera_centre(const adcgs_scene *scene, uint32_t view, double centre[3])
{
    for (int a = 0; a < 3; a++)
        centre[a] = scene->views[ADCGS_SPLIT_TRAIN][view].camera.cam_to_world[4 * a + 3];
}

static double distance(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/** Sets *extent to the median distance of the points from the first camera; 0 without points. */
static adcgs_status points_extent(const adcgs_scene *scene, double *extent, adcgs_error *error)
{
    const uint32_t all = scene->points.n, n = ADCGS_MIN(all, POINTS_MOST);
    double centre[3];
    *extent = 0.0;
    if (!n)
        return ADCGS_OK;
    double *distances = adcgs_alloc(NULL, n, sizeof *distances, error);
    if (!distances)
        return adcgs_alloc_status(error);
    camera_centre(scene, 0, centre);
    for (uint32_t i = 0; i < n; i++) {
        distances[i] = distance(scene->points.position[(uint64_t)i * all / n], centre);
    }
    adcgs_sort(distances, n);
    *extent = isfinite(distances[n / 2]) ? distances[n / 2] : 0.0;
    adcgs_free(NULL, distances);
    return ADCGS_OK;
}

/** The extent from the cameras' distances from the first camera; 1 if all cameras share one position. */
static double spread_extent(const adcgs_scene *scene)
{
    double first[3], other[3], spread = 0.0, far = 0.0;
    camera_centre(scene, 0, first);
    for (uint32_t v = 0; v < scene->n_views[ADCGS_SPLIT_TRAIN]; v++) {
        camera_centre(scene, v, other);
        spread = fmax(spread, distance(first, other));
        far = fmax(far, fmax(fabs(other[0]), fmax(fabs(other[1]), fabs(other[2]))));
    }
    return spread > ADCGS_EXTENT_NOTHING * far ? SPREADS_PER_EXTENT * spread : 1.0;
}

adcgs_status adcgs_scene_extent(const adcgs_scene *scene, double *extent, adcgs_error *error)
{
    ADCGS_TRY(points_extent(scene, extent, error));
    if (!(*extent > 0.0))
        *extent = scene->near_bound > 0.0 ? BOUNDS_PER_EXTENT * scene->near_bound : spread_extent(scene);
    return ADCGS_OK;
}
