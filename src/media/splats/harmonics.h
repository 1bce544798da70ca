/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Spherical harmonics as 3D Gaussian splatting orders and signs them. */
#ifndef ADCGS_MEDIA_SPLATS_HARMONICS_H
#define ADCGS_MEDIA_SPLATS_HARMONICS_H

#define ADCGS_HARMONICS_MAX 15 /**< harmonics of degrees 1 to 3; arithmetic, 4^2 - 1 */

/** The (degree+1)^2 - 1 real harmonics above degree 0, degree 0..3, in the direction of a unit vector. */
void adcgs_harmonics(double out[ADCGS_HARMONICS_MAX], const double direction[3], int degree);

#endif
