/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Spherical harmonics as 3D Gaussian splatting orders and signs them. */
#include "config.h"

#include "media/splats/harmonics.h"

/* Definition: the square roots of rationals over pi that make each harmonic's square integrate to 1 over the sphere. */
#define C1 0.4886025119029199  /* sqrt(3 / 4 pi) */
#define C2A 1.0925484305920792 /* sqrt(15 / 4 pi) */
#define C2B 0.3153915652525200 /* sqrt(5 / 16 pi) */
#define C3A 0.5900435899266435 /* sqrt(35 / 32 pi) */
#define C3B 2.8906114426405540 /* sqrt(105 / 4 pi) */
#define C3C 0.4570457994644657 /* sqrt(21 / 32 pi) */
#define C3D 0.3731763325901154 /* sqrt(7 / 16 pi) */

void adcgs_harmonics(double out[ADCGS_HARMONICS_MAX], const double direction[3], int degree)
{
    const double x = direction[0], y = direction[1], z = direction[2], xx = x * x, yy = y * y, zz = z * z;
    if (degree >= 1) {
        out[0] = -C1 * y;
        out[1] = C1 * z;
        out[2] = -C1 * x;
    }
    if (degree >= 2) {
        out[3] = C2A * x * y;
        out[4] = -C2A * y * z;
        out[5] = C2B * (2.0 * zz - xx - yy);
        out[6] = -C2A * x * z;
        out[7] = 0.5 * C2A * (xx - yy);
    }
    if (degree >= 3) {
        out[8] = -C3A * y * (3.0 * xx - yy);
        out[9] = C3B * x * y * z;
        out[10] = -C3C * y * (4.0 * zz - xx - yy);
        out[11] = C3D * z * (2.0 * zz - 3.0 * xx - 3.0 * yy);
        out[12] = -C3C * x * (4.0 * zz - xx - yy);
        out[13] = 0.5 * C3B * z * (xx - yy);
        out[14] = -C3A * x * (xx - 3.0 * yy);
    }
}
