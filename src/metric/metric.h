/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of pictures, in double precision. Images are planar [3][height][width], range 0..1. Where the second has NaN, in all
 * channels, it is not known: PSNR and SSIM are means over the other pixels, to whose windows, and to MS-SSIM, those are right.
 */
#ifndef ADCGS_METRIC_METRIC_H
#define ADCGS_METRIC_METRIC_H

#include "base/base.h"

/** Peak signal-to-noise ratio in dB over all pixels and channels; 99 for identical pictures, and where no pixel is known. */
double adcgs_psnr(const float *a, const float *b, size_t n);
double adcgs_psnr_from_mse(double mse);
/**
 * Planes of n pixels with the gain and the black level of each channel that bring a nearest to b, by least squares: what is left
 * of their difference is not a camera's exposure and white balance, which no other picture tells.
 */
void adcgs_fit_levels(float *fitted, const float *a, const float *b, size_t n);
/** Structural similarity: 11x11 Gaussian, sigma 1.5, zero padding, mean over pixels and channels, K1 = 0.01, K2 = 0.03. */
adcgs_status adcgs_ssim(const float *a, const float *b, int width, int height, double *ssim, adcgs_error *error);

#define ADCGS_MS_SSIM_SCALES 5

/**
 * Multi-scale structural similarity (Wang, Simoncelli and Bovik 2003): the product over five scales of the mean of contrast times
 * structure, at the last scale of the mean of the whole similarity, raised to 0.0448, 0.2856, 0.3001, 0.2363, 0.1333. A mean
 * below 0 counts as 0. Per channel, then the mean over channels. Window and constants are those of adcgs_ssim(), but only pixels
 * count whose window lies inside the picture. From scale to scale, means of 2x2 pixels; boxes at an odd edge take what they
 * cover. Where the window does not fit into a scale, that scale and the ones after it are left out, and the exponents of the
 * others are divided by their sum. *scales: how many were used. Pictures smaller than the window: 0 scales, not a number.
 */
adcgs_status adcgs_ms_ssim(const float *a, const float *b, int width, int height, double *ms_ssim, int *scales,
                           adcgs_error *error);

#endif
