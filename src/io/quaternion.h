/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The rotation that a quaternion is, as files of cameras and of splats have them. */
#ifndef ADCGS_IO_QUATERNION_H
#define ADCGS_IO_QUATERNION_H

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

#endif
