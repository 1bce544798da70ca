/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Small windows of pictures, compared by correlation. */
#ifndef ADCGS_STEREO_WINDOW_H
#define ADCGS_STEREO_WINDOW_H

#include "stereo/rig.h"

enum { ADCGS_WINDOW_SIDE = 7, ADCGS_WINDOW = ADCGS_WINDOW_SIDE * ADCGS_WINDOW_SIDE };
#define ADCGS_WINDOW_TEXTURE 4e-4f /**< variance of one that can be found again */

/**
 * A window about a place, right and down: from one of its pixels to the next, as numbers of mean 0 and length 1. \return its
 * variance, NaN where it is not all known.
 */
float adcgs_window_take(float out[ADCGS_WINDOW], const adcgs_stereo_view *view, const double at[2], const double right[2],
                        const double down[2]);

/** The correlation of two. */
static inline float adcgs_window_alike(const float a[ADCGS_WINDOW], const float b[ADCGS_WINDOW])
{
    float sum = 0;
    for (int i = 0; i < ADCGS_WINDOW; i++)
        sum += a[i] * b[i];
    return sum;
}

/**
 * Where a pixel of one view, at a depth, lies in another, and where its neighbours to the right and below lie from there. 0 if it
 * is behind that; it may lie beside its picture.
 */
int adcgs_window_pass(const adcgs_stereo_view *from, const adcgs_stereo_view *to, int px, int py, double depth, double at[2],
                      double right[2], double down[2]);

#endif
