/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of images, in double precision. Images are planar [3][height][width],
 * range 0..1. NaN in all channels of the second image marks an unknown pixel.
 * PSNR and SSIM are means over the other pixels. In the windows of these, and
 * in MS-SSIM, unknown pixels count as equal to the first image.
 */
#ifndef ADCGS_METRIC_METRIC_H
#define ADCGS_METRIC_METRIC_H

#include "base/base.h"

/** Peak signal-to-noise ratio in dB over all pixels and channels; 99 for identical images, and if no pixel is known. */
double adcgs_psnr(const float *a, const float *b, size_t n);
double adcgs_psnr_from_mse(double mse);
/**
 * Apply to a, planes of n pixels, the gain and black level per channel that fit b best by least squares. The remaining difference
 * is not due to a camera's exposure and white balance, which other images do not give.
 */
void adcgs_fit_levels(float *fitted, const float *a, const float *b, size_t n);
/** Structural similarity: 11x11 Gaussian, sigma 1.5, zero padding, mean over pixels and channels, K1 = 0.01, K2 = 0.03. */
adcgs_status adcgs_ssim(const float *a, const float *b, int width, int height, double *ssim, adcgs_error *error);

#define ADCGS_MS_SSIM_SCALES 5 /**< scales; literature: see below */

/**
 * Multi-scale structural similarity (Wang, Simoncelli and Bovik 2003): a product over five scales, with exponents 0.0448, 0.2856,
 * 0.3001, 0.2363, 0.1333. Each factor is the mean of contrast times structure; at the last scale it is the mean of the whole
 * similarity. A mean below 0 counts as 0. Computed per channel, then averaged over channels. Window and constants are those of
 * adcgs_ssim(), but only pixels count whose window lies inside the image. Each scale is the previous one reduced by means of 2x2
 * pixels; incomplete boxes at an edge average the pixels that they cover. Scales smaller than the window are left out, and the
 * exponents of the others are divided by their sum. *scales: the number of scales used. For images smaller than the window, 0
 * scales and NaN.
 */
adcgs_status adcgs_ms_ssim(const float *a, const float *b, int width, int height, double *ms_ssim, int *scales,
                           adcgs_error *error);

#endif
