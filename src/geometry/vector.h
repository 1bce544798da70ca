/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Vectors of three numbers in binary64, for all mathematics of cameras. */
#ifndef ADCGS_GEOMETRY_VECTOR_H
#define ADCGS_GEOMETRY_VECTOR_H

#include <math.h>

static inline double adcgs_v3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** out must be neither a nor b. */
static inline void adcgs_v3_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/** Scale to length 1. \return the previous length; a vector of length 0 is unchanged */
static inline double adcgs_v3_normalise(double v[3])
{
    const double length = sqrt(adcgs_v3_dot(v, v));
    for (int i = 0; i < 3 && length > 0.0; i++)
        v[i] /= length;
    return length;
}

/** Rotate about an axis of length 1 by an angle of this sine and cosine (Rodrigues' formula). */
static inline void adcgs_v3_rotate(const double axis[3], double sine, double cosine, double v[3])
{
    const double along = adcgs_v3_dot(axis, v) * (1.0 - cosine);
    double side[3];
    adcgs_v3_cross(axis, v, side);
    for (int i = 0; i < 3; i++)
        v[i] = v[i] * cosine + side[i] * sine + axis[i] * along;
}

#endif
