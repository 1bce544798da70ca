/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Checks of camera poses, and measures of the cameras' arrangement. */
#include "config.h"

#include "scene/pose_check.h"

#include "system/sort_values.h"

#include <math.h>

/* Chosen by hand, not measured. */
/* |determinant| relative to that of a rotation of the same scale, below which a pose is singular. */
#define SINGULAR 1e-6
#define PRIOR 1e-3 /* weight of the mean of the cameras in the point nearest to all axes, relative to one axis */

/** G = R^T R of the 3x3 part of a 3x4 matrix. */
static void gram(const double pose[12], double g[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            g[i][j] = pose[i] * pose[j] + pose[4 + i] * pose[4 + j] + pose[8 + i] * pose[8 + j];
}

static double determinant(const double p[12])
{
    return p[0] * (p[5] * p[10] - p[6] * p[9]) - p[1] * (p[4] * p[10] - p[6] * p[8]) + p[2] * (p[4] * p[9] - p[5] * p[8]);
}

/** Largest entry of |G/s - I|. */
static double deviation(double g[3][3], double s)
{
    double worst = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            worst = fmax(worst, fabs(g[i][j] / s - (i == j)));
    return worst;
}

/** One Newton step towards the nearest rotation: R (3I - R^T R) / 2. Convergence is quadratic; three steps reach rounding. */
static void straighten(double pose[12])
{
    double g[3][3], r[3][3];
    gram(pose, g);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            r[i][j] = 0.0;
            for (int k = 0; k < 3; k++)
                r[i][j] += pose[4 * i + k] * ((k == j ? 1.5 : 0.0) - 0.5 * g[k][j]);
        }
    for (int i = 0; i < 3; i++)
        memcpy(pose + 4 * i, r[i], sizeof r[i]);
}

const char *adcgs_pose_check(double pose[12])
{
    double g[3][3];
    for (int i = 0; i < 12; i++)
        if (!isfinite(pose[i]))
            return "holds a value that is not finite";
    gram(pose, g);
    const double det = determinant(pose), scale = (g[0][0] + g[1][1] + g[2][2]) / 3.0;
    if (!isfinite(scale) || !isfinite(det))
        return "holds values that are too large";
    if (scale <= 0.0 || fabs(det) < SINGULAR * scale * sqrt(scale))
        return "is singular";
    if (deviation(g, 1.0) > ADCGS_POSE_TOLERANCE)
        return deviation(g, scale) <= ADCGS_POSE_TOLERANCE ? "is scaled, expected a rotation"
                                                           : "is not orthonormal, expected a rotation";
    if (det < 0.0)
        return "is a reflection, expected a rotation";
    for (int i = 0; i < 3; i++)
        straighten(pose);
    return NULL;
}

const char *adcgs_pose_from_opengl(double pose[12])
{
    const char *wrong = adcgs_pose_check(pose);
    for (int i = 0; !wrong && i < 3; i++) {
        pose[4 * i + 1] = -pose[4 * i + 1];
        pose[4 * i + 2] = -pose[4 * i + 2];
    }
    return wrong;
}

uint8_t adcgs_pose_axes(const adcgs_scene_view *views, uint32_t n)
{
    double up[3] = {0.0, 0.0, 0.0};
    for (uint32_t v = 0; v < n; v++)
        for (int i = 0; i < 3; i++)
            up[i] -= views[v].camera.cam_to_world[4 * i + 1];
    if (fabs(up[1]) > fabs(up[0]) && fabs(up[1]) > fabs(up[2]))
        return up[1] > 0.0 ? ADCGS_AXES_Y_UP : ADCGS_AXES_Y_DOWN;
    return up[2] > fabs(up[0]) ? ADCGS_AXES_Z_UP : ADCGS_AXES_UNKNOWN;
}

/** Solves the symmetric positive definite 3x3 system a x = b by Cramer's rule. */
static void solve(double a[3][3], const double b[3], double x[3])
{
    double m[12] = {a[0][0], a[0][1], a[0][2], 0, a[1][0], a[1][1], a[1][2], 0, a[2][0], a[2][1], a[2][2], 0};
    const double whole = determinant(m);
    for (int c = 0; c < 3; c++) {
        double n[12];
        memcpy(n, m, sizeof n);
        for (int i = 0; i < 3; i++)
            n[4 * i + c] = b[i];
        x[c] = determinant(n) / whole;
    }
}

/** Minimises the squared distances from all axes. */
void adcgs_pose_centre(const adcgs_scene_view *views, uint32_t n, double centre[3])
{
    double a[3][3] = {{0}}, b[3] = {0}, mean[3] = {0};
    for (uint32_t v = 0; v < n; v++) {
        const double *p = views[v].camera.cam_to_world;
        for (int i = 0; i < 3; i++) {
            mean[i] += p[4 * i + 3] / n;
            for (int j = 0; j < 3; j++) {
                const double across = (i == j) - p[4 * i + 2] * p[4 * j + 2];
                a[i][j] += across;
                b[i] += across * p[4 * j + 3];
            }
        }
    }
    for (int i = 0; i < 3; i++) {
        a[i][i] += PRIOR * n;
        b[i] += PRIOR * n * mean[i];
    }
    solve(a, b, centre);
}

adcgs_status adcgs_pose_median_distance(const adcgs_scene_view *views, uint32_t n, double *median, adcgs_error *error)
{
    double centre[3];
    double *distances = adcgs_alloc(NULL, n, sizeof *distances, error);
    *median = 0.0;
    if (!distances)
        return adcgs_alloc_status(error);
    adcgs_pose_centre(views, n, centre);
    for (uint32_t v = 0; v < n; v++) {
        const double *p = views[v].camera.cam_to_world;
        distances[v] = sqrt((p[3] - centre[0]) * (p[3] - centre[0]) + (p[7] - centre[1]) * (p[7] - centre[1]) +
                            (p[11] - centre[2]) * (p[11] - centre[2]));
    }
    adcgs_sort(distances, n);
    if (n && isfinite(distances[n / 2]))
        *median = distances[n / 2];
    adcgs_free(NULL, distances);
    return ADCGS_OK;
}
