/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How long a length is. */
#include "config.h"

#include "data/extent.h"

#include "data/sort.h"

#include <math.h>
#include <stdlib.h>

#define POINTS_MOST 10000 /* that are looked at */
#define BOUNDS_PER_EXTENT 4
#define SPREADS_PER_EXTENT 4

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

/** The median distance of points from the first camera; 0 without any. */
static double points_extent(const adcgs_scene *scene)
{
    const uint32_t all = scene->points.n, n = ADCGS_MIN(all, POINTS_MOST);
    double centre[3], *distances = n ? malloc(n * sizeof *distances) : NULL;
    if (!distances)
        return 0.0;
    camera_centre(scene, 0, centre);
    for (uint32_t i = 0; i < n; i++) {
        const float *p = scene->points.position[(uint64_t)i * all / n];
        distances[i] = distance((const double[3]){(double)p[0], (double)p[1], (double)p[2]}, centre);
    }
    adcgs_sort(distances, n);
    const double median = distances[n / 2];
    free(distances);
    return isfinite(median) ? median : 0.0;
}

double adcgs_scene_extent(const adcgs_scene *scene)
{
    const double of_points = points_extent(scene);
    double first[3], other[3], spread = 0.0, far = 0.0;
    if (of_points > 0.0)
        return of_points;
    if (scene->near_bound > 0.0)
        return BOUNDS_PER_EXTENT * scene->near_bound;
    camera_centre(scene, 0, first);
    for (uint32_t v = 0; v < scene->n_views[ADCGS_SPLIT_TRAIN]; v++) {
        camera_centre(scene, v, other);
        spread = fmax(spread, distance(first, other));
        far = fmax(far, fmax(fabs(other[0]), fmax(fabs(other[1]), fabs(other[2]))));
    }
    return spread > ADCGS_EXTENT_NOTHING * far ? SPREADS_PER_EXTENT * spread : 1.0;
}
