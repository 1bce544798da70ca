/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Angles and rotations. */
#include "config.h"

#include "camera/euler.h"

#include <math.h>
#include <string.h>

/* Origin, unless a line states one: chosen by hand, not measured. */
#define DEGREE 0.017453292519943295 /* radians; definition */
#define LEVEL 1e-9                  /* cosine of the middle angle below which the first and the last axis coincide */

const char *const adcgs_rotation_orders[] = {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx", NULL};

/** m = R m, R about an axis. */
static void turn(double m[3][3], int axis, double angle)
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++) {
        const double u = m[a][i], v = m[b][i];
        m[a][i] = c * u - s * v;
        m[b][i] = s * u + c * v;
    }
}

void adcgs_euler_to_pose(const double degrees[3], adcgs_rotation_order order, double pose[12])
{
    double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const char *axis = adcgs_rotation_orders[order]; *axis; axis++)
        turn(m, *axis - 'x', DEGREE * degrees[*axis - 'x']);
    for (int i = 0; i < 3; i++)
        memcpy(pose + 4 * i, m[i], sizeof m[i]);
}

/** Add whole turns to get nearest to `to`. */
static double nearest(double degrees, double to)
{
    return degrees + 360.0 * round((to - degrees) / 360.0);
}

void adcgs_euler_from_pose(const double pose[12], adcgs_rotation_order order, double degrees[3])
{
    const char *const axes = adcgs_rotation_orders[order];
    const int i = axes[0] - 'x', j = axes[1] - 'x', k = axes[2] - 'x';
    const double sign = (i + 1) % 3 == j ? 1.0 : -1.0; /* 1 if the axes are in cyclic order */
#define M(a, b) pose[4 * (a) + (b)]
    const double level = hypot(M(k, j), M(k, k));
    double angles[3] = {0};
    angles[j] = atan2(-sign * M(k, i), level);
    angles[i] = level > LEVEL ? atan2(sign * M(k, j), M(k, k)) : atan2(-sign * M(j, k), M(j, j));
    angles[k] = level > LEVEL ? atan2(sign * M(j, i), M(i, i)) : 0.0;
#undef M
    for (int a = 0; a < 3; a++)
        degrees[a] = nearest(angles[a] / DEGREE, degrees[a]);
}
