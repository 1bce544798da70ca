/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Rotations as quaternions and as matrices, as in files of cameras and of splats. */
#ifndef ADCGS_GEOMETRY_QUATERNION_MATRIX_H
#define ADCGS_GEOMETRY_QUATERNION_MATRIX_H

#include <math.h>

/** q: w, x, y, z, of length 1; m: its matrix, row by row. */
static inline void adcgs_quaternion_matrix(const double q[4], double m[9])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    m[0] = 1 - 2 * (y * y + z * z);
    m[1] = 2 * (x * y - w * z);
    m[2] = 2 * (x * z + w * y);
    m[3] = 2 * (x * y + w * z);
    m[4] = 1 - 2 * (x * x + z * z);
    m[5] = 2 * (y * z - w * x);
    m[6] = 2 * (x * z - w * y);
    m[7] = 2 * (y * z + w * x);
    m[8] = 1 - 2 * (x * x + y * y);
}

/**
 * The quaternion w, x, y, z, of length 1, of a rotation matrix, row by row. The largest component is found first (Shepperd,
 * 1978): dividing by it is safe, and it is positive.
 */
static inline void adcgs_quaternion_of(const double m[9], double q[4])
{
    const double trace = m[0] + m[4] + m[8];
    int i = m[4] > m[0] ? 1 : 0;
    i = m[8] > m[4 * i] ? 2 : i;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (trace > m[4 * i]) {
        q[0] = 1.0 + trace;
        q[1] = m[7] - m[5];
        q[2] = m[2] - m[6];
        q[3] = m[3] - m[1];
    } else {
        q[0] = m[3 * k + j] - m[3 * j + k];
        q[1 + i] = 1.0 + m[4 * i] - m[4 * j] - m[4 * k];
        q[1 + j] = m[3 * j + i] + m[3 * i + j];
        q[1 + k] = m[3 * k + i] + m[3 * i + k];
    }
    const double length = sqrt(q[0] * q[0] + (q[1] * q[1] + q[2] * q[2] + q[3] * q[3]));
    for (int a = 0; a < 4; a++)
        q[a] /= length;
}

#endif
