/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Small windows of images, compared by correlation. */
#ifndef ADCGS_INIT_MATCH_WINDOW_H
#define ADCGS_INIT_MATCH_WINDOW_H

#include "init/rig.h"

/** Side of a window, pixels, and its number of pixels; chosen by hand, not measured. */
enum { ADCGS_WINDOW_SIDE = 7, ADCGS_WINDOW = ADCGS_WINDOW_SIDE * ADCGS_WINDOW_SIDE };
/** Minimum variance of a window that can be found again, values of 0 to 1; chosen by hand, not measured. */
#define ADCGS_WINDOW_TEXTURE 4e-4f

/**
 * Samples a window around a position and normalises it to mean 0 and norm 1. right, down: steps between its pixels. \return its
 * variance, NaN if it is not fully known.
 */
float adcgs_window_sample(float out[ADCGS_WINDOW], const adcgs_stereo_view *view, const double at[2], const double right[2],
                          const double down[2]);

/** Correlation of two windows. */
static inline float adcgs_window_correlation(const float a[ADCGS_WINDOW], const float b[ADCGS_WINDOW])
{
    float sum = 0;
    for (int i = 0; i < ADCGS_WINDOW; i++)
        sum += a[i] * b[i];
    return sum;
}

/**
 * Maps a pixel of one view, at a depth, to another view, with the steps to its right and lower neighbours. Returns 0 if it is
 * behind that camera. The position may be outside the image.
 */
int adcgs_window_pass(const adcgs_stereo_view *from, const adcgs_stereo_view *to, int px, int py, double depth, double at[2],
                      double right[2], double down[2]);

#endif
