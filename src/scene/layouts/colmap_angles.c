/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Triangulation angles of a sparse model. */
#include "config.h"

#include "scene/layouts/colmap_angles.h"

#include <math.h>
#include <stdlib.h>

#define DEGREES 57.29577951308232 /* of a radian; definition */

static int compare_centres(const void *a, const void *b)
{
    const uint32_t x = ((const adcgs_colmap_centre *)a)->id, y = ((const adcgs_colmap_centre *)b)->id;
    return (x > y) - (x < y);
}

void adcgs_colmap_angles_init(adcgs_colmap_angles *angles, adcgs_colmap_centre *centre, size_t n)
{
    *angles = (adcgs_colmap_angles){.centre = centre, .n_centres = n};
    qsort(centre, n, sizeof *centre, compare_centres);
}

void adcgs_colmap_angles_clear(adcgs_colmap_angles *angles)
{
    free(angles->centre);
    free(angles->ray);
    free(angles->angle);
    *angles = (adcgs_colmap_angles){.n = 0};
}

/** Makes room for one more element; returns 0 on failure. */
static int grow(adcgs_colmap_angles *angles, void **array, size_t *room, size_t n, size_t element)
{
    const size_t more = *room ? 2 * *room : 64;
    if (n < *room)
        return 1;
    void *const larger = realloc(*array, more * element);
    angles->failed |= !larger;
    if (!larger)
        return 0;
    *array = larger;
    *room = more;
    return 1;
}

void adcgs_colmap_angles_see(adcgs_colmap_angles *angles, const double point[3], uint32_t image)
{
    const adcgs_colmap_centre key = {.id = image}, *const centre = angles->n_centres
                                                                       ? bsearch(&key, angles->centre, angles->n_centres,
                                                                                 sizeof key, compare_centres)
                                                                       : NULL;
    void *rays = angles->ray;
    double ray[3], length = 0.0;
    for (int a = 0; centre && a < 3; a++) {
        ray[a] = centre->at[a] - point[a];
        length += ray[a] * ray[a];
    }
    if (!(length > 0.0) || !isfinite(length) || !grow(angles, &rays, &angles->ray_room, angles->n_rays, sizeof *angles->ray))
        return;
    angles->ray = rays;
    for (int a = 0; a < 3; a++)
        angles->ray[angles->n_rays][a] = ray[a] / sqrt(length);
    angles->n_rays++;
}

/** The ray whose end is farthest from that of a ray; returns the square of the distance, which is exact for small angles. */
static double find_farthest(const adcgs_colmap_angles *angles, size_t from, size_t *to)
{
    double most = 0.0;
    *to = from;
    for (size_t i = 0; i < angles->n_rays; i++) {
        double square = 0.0;
        for (int a = 0; a < 3; a++)
            square += pow(angles->ray[i][a] - angles->ray[from][a], 2.0);
        if (square > most) {
            most = square;
            *to = i;
        }
    }
    return most;
}

/** The largest angle of a path of cameras is between its ends: those farthest from any, and from that one. */
void adcgs_colmap_angles_end_point(adcgs_colmap_angles *angles)
{
    void *all = angles->angle;
    size_t end, other;
    if (angles->n_rays >= 2 && grow(angles, &all, &angles->room, angles->n, sizeof *angles->angle)) {
        angles->angle = all;
        find_farthest(angles, 0, &end);
        const double chord = sqrt(find_farthest(angles, end, &other));
        angles->angle[angles->n++] = 2.0 * DEGREES * asin(fmin(0.5 * chord, 1.0));
    }
    angles->n_rays = 0;
}

static int compare_angles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double adcgs_colmap_angles_median(adcgs_colmap_angles *angles)
{
    if (!angles->n)
        return 0.0;
    qsort(angles->angle, angles->n, sizeof *angles->angle, compare_angles);
    return angles->angle[angles->n / 2];
}
