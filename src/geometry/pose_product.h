/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Products of poses and of other matrices of 3x4 numbers, row by row. */
#ifndef ADCGS_GEOMETRY_POSE_PRODUCT_H
#define ADCGS_GEOMETRY_POSE_PRODUCT_H

#include <string.h>

/** out = a b, as of matrices with a last row of 0 0 0 1; out may be either. */
static inline void adcgs_pose_product(const double a[12], const double b[12], double out[12])
{
    double product[12];
    for (int i = 0; i < 12; i++) {
        const double *const row = a + i / 4 * 4, *const column = b + i % 4;
        product[i] = row[0] * column[0] + row[1] * column[4] + row[2] * column[8] + (i % 4 == 3 ? row[3] : 0.0);
    }
    memcpy(out, product, sizeof product);
}

#endif
