/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The scene's frame of reference. */
#include "train/scene_frame.h"

#include "data/extent.h"
#include "data/sort.h"

#include <math.h>

/** Solve the symmetric 3x3 system a x = b by Cramer's rule; 0 if it is singular. */
static int solve3(const double a[9], const double b[3], double x[3])
{
    const double c0 = a[4] * a[8] - a[5] * a[7], c1 = a[5] * a[6] - a[3] * a[8], c2 = a[3] * a[7] - a[4] * a[6];
    const double det = a[0] * c0 + a[1] * c1 + a[2] * c2;
    if (fabs(det) < 1e-9)
        return 0;
    x[0] = (b[0] * c0 + b[1] * (a[2] * a[7] - a[1] * a[8]) + b[2] * (a[1] * a[5] - a[2] * a[4])) / det;
    x[1] = (b[0] * c1 + b[1] * (a[0] * a[8] - a[2] * a[6]) + b[2] * (a[2] * a[3] - a[0] * a[5])) / det;
    x[2] = (b[0] * c2 + b[1] * (a[1] * a[6] - a[0] * a[7]) + b[2] * (a[0] * a[4] - a[1] * a[3])) / det;
    return 1;
}

/** The point nearest to all optical axes in the least-squares sense, pulled slightly towards the points the cameras face. */
static void focus_point(const adcgs_scene *scene, double extent, double focus[3])
{
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double a[9] = { 0 }, b[3] = { 0 };
    for (uint32_t v = 0; v < n; v++) {
        const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
        const double d[3] = { m[2], m[6], m[10] }, c[3] = { m[3], m[7], m[11] };
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const double p = (i == j) - d[i] * d[j];
                a[i * 3 + j] += p / n;
                b[i] += p * c[j] / n;
            }
    }
    if (!solve3(a, b, focus)) /* parallel axes: in front of the first camera */
        for (int i = 0; i < 3; i++) {
            const double *m = scene->views[ADCGS_SPLIT_TRAIN][0].camera.cam_to_world;
            focus[i] = m[4 * i + 3] + extent * m[4 * i + 2];
        }
}

adcgs_status adcgs_scene_frame(const adcgs_scene *part, double origin[3], double *scale, adcgs_error *error)
{
    const adcgs_scene *scene = part->whole ? part->whole : part;
    const uint32_t n = scene->n_views[ADCGS_SPLIT_TRAIN];
    double extent;
    if (scene->scale > 0) {
        memcpy(origin, scene->origin, sizeof scene->origin);
        *scale = scene->scale;
        return ADCGS_OK;
    }
    ADCGS_TRY(adcgs_scene_extent(scene, &extent, error));
    focus_point(scene, extent, origin);
    double *distance = adcgs_alloc(NULL, n, sizeof *distance, error);
    if (!distance)
        return adcgs_alloc_status(error);
    for (uint32_t v = 0; v < n; v++) {
        const double *m = scene->views[ADCGS_SPLIT_TRAIN][v].camera.cam_to_world;
        const double d[3] = { m[3] - origin[0], m[7] - origin[1], m[11] - origin[2] };
        distance[v] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    adcgs_sort(distance, n);
    *scale = distance[n / 2] > ADCGS_EXTENT_NOTHING * extent ? distance[n / 2] : extent; /* all may stand in one place */
    adcgs_free(NULL, distance);
    return ADCGS_OK;
}
