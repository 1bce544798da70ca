/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sine and cosine without a library. */
#include "synthetic/sine.h"

#define PI 3.14159265358979323846 /* geometry */

/* Odd Taylor polynomial of the sine within a quarter turn of zero; its error there is below 1e-11. */
static double sin_core(double x)
{
    const double y = x * x;
    double s = -1.0 / 1307674368000.0;
    s = s * y + 1.0 / 6227020800.0;
    s = s * y - 1.0 / 39916800.0;
    s = s * y + 1.0 / 362880.0;
    s = s * y - 1.0 / 5040.0;
    s = s * y + 1.0 / 120.0;
    s = s * y - 1.0 / 6.0;
    return x + x * y * s;
}

double adcgs_trace_sin(double turns)
{
    double f = turns - (double)(int)turns;
    f = f > 0.5 ? f - 1.0 : f < -0.5 ? f + 1.0 : f;
    f = f > 0.25 ? 0.5 - f : f < -0.25 ? -0.5 - f : f;
    return sin_core(2.0 * PI * f);
}

double adcgs_trace_cos(double turns)
{
    return adcgs_trace_sin(turns + 0.25);
}
