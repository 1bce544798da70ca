/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Price of size. */
#include "train/area.h"

double adcgs_area_price(const adcgs_primitives *primitives, float weight, float *const scale[3])
{
    const float *x = primitives->scale[0], *y = primitives->scale[1], *z = primitives->scale[2];
    uint32_t n = 0;
    double area = 0;
    for (uint32_t i = 0; i < primitives->n; i++)
        n += primitives->opacity[i] > 0;
    const float each = weight / (3 * (float)ADCGS_MAX(n, 1u));
    for (uint32_t i = 0; i < primitives->n; i++) {
        if (!(primitives->opacity[i] > 0))
            continue;
        area += (double)(x[i] * y[i] + y[i] * z[i] + z[i] * x[i]);
        scale[0][i] += each * (y[i] + z[i]);
        scale[1][i] += each * (z[i] + x[i]);
        scale[2][i] += each * (x[i] + y[i]);
    }
    return (double)each * area;
}
