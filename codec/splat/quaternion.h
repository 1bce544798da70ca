/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quaternions w, x, y, z in strict binary32 (spec clause "Quaternions"), one by one or in loops over lanes. */
#ifndef ADCGS_SPLAT_QUATERNION_H
#define ADCGS_SPLAT_QUATERNION_H

#include "base/fmath.h"

/** Whether a squared norm is within the range that can be normalised. Outside, the quaternion becomes the identity. */
static inline int adcgs_usable_norm(float n)
{
    return n >= 0x1p-40f && n <= 0x1p100f;
}

static inline float adcgs_norm2(float w, float x, float y, float z)
{
    return fmaf(z, z, fmaf(y, y, fmaf(x, x, w * w)));
}

/** The matrix of a normalised quaternion, row-major. */
static inline void adcgs_rotation_matrix(float matrix[9], float w, float x, float y, float z)
{
    const float x2 = x + x, y2 = y + y, z2 = z + z;
    matrix[0] = fmaf(-y2, y, fmaf(-z2, z, 1.0f));
    matrix[1] = fmaf(x2, y, -(w * z2));
    matrix[2] = fmaf(x2, z, w * y2);
    matrix[3] = fmaf(x2, y, w * z2);
    matrix[4] = fmaf(-x2, x, fmaf(-z2, z, 1.0f));
    matrix[5] = fmaf(y2, z, -(w * x2));
    matrix[6] = fmaf(x2, z, -(w * y2));
    matrix[7] = fmaf(y2, z, w * x2);
    matrix[8] = fmaf(-x2, x, fmaf(-y2, y, 1.0f));
}

#endif
