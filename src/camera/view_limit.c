/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The region that was filmed. */
#include "config.h"

#include "camera/view_limit.h"

#include "base/base.h"
#include "geometry/rotation.h"

#include <math.h>
#include <stdlib.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
/*
 * Distances to the pivot: an orbit of 20 degrees moves by 0.35 of them (geometry). Checked on 14 streams of all kinds: that
 * orbit showed at most 11 % more background than the filmed images.
 */
#define RADIUS 0.36
#define ANGLE 0.4         /* radians between viewing directions: a little more than that orbit */
#define SPACING_SHARE 0.6 /* of the distance of neighbours, so that the regions of neighbouring cameras touch */
#define FORWARD_COST 0.35 /* of a step forward relative to one aside: the image shows nothing that was not in it before */
#define BELOW_LEAST 0.25  /* of the tolerances: 6 degrees remain below cameras that look ahead, and 11 at the limit */
#define STEPS_PER_KEY 4   /* poses of a path from one key to the next */

/** Distance of two poses: level, and along up. */
static void find_way(const adcgs_view_limit *limit, const double a[12], const double b[12], double way[2])
{
    const double by[3] = {a[3] - b[3], a[7] - b[7], a[11] - b[11]};
    way[1] = fabs(adcgs_v3_dot(by, limit->up));
    way[0] = sqrt(fmax(0, adcgs_v3_dot(by, by) - way[1] * way[1]));
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** Median way from a pose to its nearest neighbour, on each axis. */
static adcgs_status find_spacing(adcgs_view_limit *limit, adcgs_error *error)
{
    double *const nearest = calloc(2 * (size_t)limit->n, sizeof *nearest);
    if (!nearest)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d cameras", limit->n);
    for (int i = 0; i < limit->n; i++) {
        double least = INFINITY, way[2];
        for (int j = 0; j < limit->n; j++) {
            find_way(limit, limit->pose[i], limit->pose[j], way);
            if (j == i || hypot(way[0], way[1]) >= least)
                continue;
            least = hypot(way[0], way[1]);
            nearest[i] = way[0];
            nearest[limit->n + i] = way[1];
        }
    }
    for (int axis = 0; axis < 2; axis++) {
        qsort(nearest + axis * limit->n, (size_t)limit->n, sizeof *nearest, compare);
        limit->spacing[axis] = nearest[axis * limit->n + limit->n / 2];
    }
    free(nearest);
    return ADCGS_OK;
}

/** The angle by which a pose looks down [radians]; 0 if up is not known. */
static double look_down(const adcgs_view_limit *limit, const double pose[12])
{
    const double sine = -(pose[2] * limit->up[0] + pose[6] * limit->up[1] + pose[10] * limit->up[2]);
    return asin(ADCGS_MAX(-1, ADCGS_MIN(1, sine)));
}

static double height_of(const adcgs_view_limit *limit, const double pose[12])
{
    return pose[3] * limit->up[0] + pose[7] * limit->up[1] + pose[11] * limit->up[2];
}

/** Where all cameras look down, the limit is at most at the level of the scene: no view comes below. */
static void find_lowest(adcgs_view_limit *limit, int has_up)
{
    limit->lowest = limit->flattest = INFINITY;
    for (int i = 0; i < limit->n; i++) {
        limit->lowest = fmin(limit->lowest, height_of(limit, limit->pose[i]));
        limit->flattest = fmin(limit->flattest, look_down(limit, limit->pose[i]));
    }
    limit->below = has_up ? fmax(BELOW_LEAST, fmin(0.5 * limit->flattest / ANGLE, 1)) : 1;
}

adcgs_status adcgs_view_limit_init(adcgs_view_limit *limit, const adcgs_filmed_camera *cameras, int n, const adcgs_follow *follow,
                                   const double up[3], double distance, adcgs_error *error)
{
    const adcgs_camera_spline *const spline = follow ? &follow->spline : NULL;
    const int steps = spline && spline->n > 1 ? STEPS_PER_KEY * (spline->n - 1) : 0;
    *limit = (adcgs_view_limit){.pose = calloc((size_t)n + (size_t)steps + 1, sizeof *limit->pose)};
    if (!limit->pose)
        return adcgs_fail(error, ADCGS_ERR_MEMORY, "out of memory for %d cameras", n);
    if (up)
        memcpy(limit->up, up, sizeof limit->up);
    for (int i = 0; i < n; i++)
        memcpy(limit->pose[limit->n++], cameras[i].camera.cam_to_world, sizeof *limit->pose);
    if (n && !steps)
        ADCGS_TRY(find_spacing(limit, error));
    for (int i = 0; i < steps; i++) {
        adcgs_camera camera;
        adcgs_follow_at(follow, follow->begin + (follow->end - follow->begin) * (i + 0.5) / steps, &camera);
        memcpy(limit->pose[limit->n++], camera.cam_to_world, sizeof *limit->pose);
    }
    find_lowest(limit, up != NULL);
    adcgs_view_limit_scale(limit, distance);
    return ADCGS_OK;
}

void adcgs_view_limit_clear(adcgs_view_limit *limit)
{
    free(limit->pose);
    *limit = (adcgs_view_limit){.n = 0};
}

void adcgs_view_limit_scale(adcgs_view_limit *limit, double distance)
{
    limit->distance = distance;
    for (int axis = 0; axis < 2; axis++)
        limit->radius[axis] = fmax(RADIUS * distance, SPACING_SHARE * limit->spacing[axis]);
}

/** How far a pose is from a filmed one, in radii or angles of the region. */
static double measure(const adcgs_view_limit *limit, const double filmed[12], const double pose[12])
{
    double by[3], rising[3], forward = 0, cosine = 0, steep = 0;
    for (int i = 0; i < 3; i++) {
        by[i] = pose[4 * i + 3] - filmed[4 * i + 3];
        forward += by[i] * filmed[4 * i + 2];
        steep += limit->up[i] * filmed[4 * i + 2];
        cosine += pose[4 * i + 2] * filmed[4 * i + 2];
    }
    for (int i = 0; i < 3; i++) {
        by[i] -= forward * filmed[4 * i + 2];
        rising[i] = limit->up[i] - steep * filmed[4 * i + 2];
    }
    adcgs_v3_normalise(rising);
    const double rise = adcgs_v3_dot(by, rising), level2 = fmax(0, adcgs_v3_dot(by, by) - rise * rise);
    if (forward > 0)
        forward *= FORWARD_COST;
    const double way =
        hypot(hypot(sqrt(level2) / limit->radius[0], rise / limit->radius[1]), forward / (RADIUS * limit->distance));
    return fmax(way, acos(ADCGS_MAX(-1, ADCGS_MIN(1, cosine))) / ANGLE);
}

/** How far a pose is below all filmed ones, or looks higher up, in tolerances. */
static double measure_below(const adcgs_view_limit *limit, const double pose[12])
{
    const double drop = (limit->lowest - height_of(limit, pose)) / (RADIUS * limit->distance);
    return fmax(drop, (limit->flattest - look_down(limit, pose)) / ANGLE) / limit->below;
}

double adcgs_view_limit_at(const adcgs_view_limit *limit, const double pose[12])
{
    double least = INFINITY;
    if (!limit->n || !(limit->distance > 0))
        return 0;
    for (int i = 0; i < limit->n; i++)
        least = fmin(least, measure(limit, limit->pose[i], pose));
    return fmax(least, measure_below(limit, pose));
}
