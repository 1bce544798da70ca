/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality over the time of one camera that stays where it is: of what moves, of what stands still, of what flickers.
 *
 * A pixel's truth changes by the largest over the channels of its largest value less its smallest over all pictures. It moves
 * where more than half of the pixels that are at most ADCGS_CHANGE_NEAR from it along both axes change by more than
 * ADCGS_CHANGE_LEAST: noise of coding changes pixels here and there, along sharp edges above all. The dynamic region holds the
 * pixels that move, and all that are at most ADCGS_CHANGE_REACH from one of them along both axes, which takes in blurred
 * borders and shadows. All other pixels are static.
 *
 * The truth comes twice: to find the region, then beside the decoded pictures. Space per pixel is that of six pictures
 * of floats, however many there are. Pictures are planar [3][height][width], range 0..1, and are not kept.
 */
#ifndef ADCGS_METRIC_TEMPORAL_H
#define ADCGS_METRIC_TEMPORAL_H

#include "base/base.h"

#define ADCGS_CHANGE_LEAST 0.1
#define ADCGS_CHANGE_NEAR 2
#define ADCGS_CHANGE_REACH 3

typedef struct adcgs_temporal adcgs_temporal;

/** What one picture gives. */
typedef struct adcgs_temporal_view {
    double dynamic_psnr; /**< dB, PSNR over the dynamic region; not a number if nothing moves */
    double flicker;      /**< mean over pixels and channels of |(d - d') - (t - t')|: d, t the decoded and the true value, d', t'
                              those of the picture before; not a number for the first picture */
} adcgs_temporal_view;

/** What the pictures together give. Variances are per pixel and channel, over n pictures divided by n, then averaged. */
typedef struct adcgs_temporal_total {
    uint32_t views;
    double dynamic_share;   /**< of all pixels, 0..1 */
    double static_variance; /**< of the decoded static pixels; not a number if there are none, as the next */
    double truth_variance;  /**< of the true ones: noise of the camera, mostly */
} adcgs_temporal_total;

adcgs_status adcgs_temporal_create(adcgs_temporal **out, int width, int height, adcgs_error *error);
void adcgs_temporal_free(adcgs_temporal **temporal);
/** Take note of a true picture, once for each, in any order; then find the region. */
void adcgs_temporal_look(adcgs_temporal *temporal, const float *truth);
adcgs_status adcgs_temporal_find_region(adcgs_temporal *temporal, adcgs_error *error);
/** [height][width], 1 in the dynamic region, else 0. */
const uint8_t *adcgs_temporal_region(const adcgs_temporal *temporal);
/** Compare the pictures, which come in ascending time. */
adcgs_temporal_view adcgs_temporal_add(adcgs_temporal *temporal, const float *decoded, const float *truth);
adcgs_temporal_total adcgs_temporal_end(const adcgs_temporal *temporal);

#endif
