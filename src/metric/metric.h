/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality of pictures, in double precision. Images are planar [3][height][width], range 0..1. */
#ifndef ADCGS_METRIC_METRIC_H
#define ADCGS_METRIC_METRIC_H

#include "base/base.h"

/** Peak signal-to-noise ratio in dB over all pixels and channels; 99 for identical pictures. */
double adcgs_psnr(const float *a, const float *b, size_t n);
double adcgs_psnr_from_mse(double mse);
/** Structural similarity: 11x11 Gaussian, sigma 1.5, zero padding, mean over pixels and channels, K1 = 0.01, K2 = 0.03. */
adcgs_status adcgs_ssim(const float *a, const float *b, int width, int height, double *ssim, adcgs_error *error);

#endif
