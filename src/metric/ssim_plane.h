/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Structural similarity of one channel, in double precision: the basis of SSIM
 * and MS-SSIM.
 */
#ifndef ADCGS_METRIC_SSIM_PLANE_H
#define ADCGS_METRIC_SSIM_PLANE_H

#include "base/base.h"

/* Literature: the window of 11x11 pixels of Wang, Bovik, Sheikh and Simoncelli, 2004; its sums by definition. */
enum {
    ADCGS_SSIM_RADIUS = 5,                       /**< pixels */
    ADCGS_SSIM_TAPS = 2 * ADCGS_SSIM_RADIUS + 1, /**< width of the window */
    ADCGS_SSIM_MOMENTS = 5                       /**< a, b, aa, bb, ab */
};

/** Sums over pixels: similarity, and its part without the luminance (contrast and structure). */
typedef struct adcgs_ssim_sums {
    double similarity, structure;
} adcgs_ssim_sums;

/** The window and scratch memory to blur rows, for images up to a width. Zero-initialise before use. */
typedef struct adcgs_ssim_space {
    double window[ADCGS_SSIM_TAPS];
    double *ring;          /**< [TAPS][MOMENTS][width] */
    double *padded;        /**< [MOMENTS][width + 2 RADIUS] */
    double *row;           /**< [MOMENTS][width] */
    const uint8_t *hidden; /**< [height][width] pixels left out of the sums; NULL: none */
} adcgs_ssim_space;

adcgs_status adcgs_ssim_space_init(adcgs_ssim_space *space, int width, adcgs_error *error);
void adcgs_ssim_space_clear(adcgs_ssim_space *space);

/**
 * Sum over the pixels of two planes [height][width] that are at least margin from each edge. With margin 0 the window sees zeros
 * beyond the edges. With margin ADCGS_SSIM_RADIUS it stays inside, and both sides must be at least ADCGS_SSIM_TAPS. width: at
 * most that of space.
 */
adcgs_ssim_sums adcgs_ssim_plane(const adcgs_ssim_space *space, const double *a, const double *b, int width, int height,
                                 int margin);

#endif
