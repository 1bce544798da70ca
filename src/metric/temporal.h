/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality over time of one static camera: of moving regions, of static regions,
 * and of flicker.
 *
 * The change of a pixel's truth is its maximum less its minimum over all
 * images, the largest of the channels. A pixel moves if more than half of the
 * pixels within ADCGS_CHANGE_NEAR along both axes change by more than
 * ADCGS_CHANGE_LEAST. A majority is needed because coding noise changes single
 * pixels, mostly along sharp edges. The dynamic region holds the moving pixels,
 * and all pixels within ADCGS_CHANGE_REACH of one along both axes, which adds
 * blurred borders and shadows. All other pixels are static.
 *
 * The true images are passed twice: to find the region, then together with the
 * decoded images. Memory per pixel is that of six images of floats, for any
 * number of images. Images are planar [3][height][width], range 0..1, and are
 * not kept.
 */
#ifndef ADCGS_METRIC_TEMPORAL_H
#define ADCGS_METRIC_TEMPORAL_H

#include "base/base.h"

/* Origin: chosen by hand, not measured. */
#define ADCGS_CHANGE_LEAST 0.1 /**< change above which a pixel counts, in the range 0..1 */
#define ADCGS_CHANGE_NEAR 2    /**< neighbourhood of the majority, pixels */
#define ADCGS_CHANGE_REACH 3   /**< dilation of the dynamic region, pixels */

typedef struct adcgs_temporal adcgs_temporal;

/** Result of one image. */
typedef struct adcgs_temporal_view {
    double dynamic_psnr; /**< dB, PSNR over the dynamic region; NaN if nothing moves */
    double flicker;      /**< mean over pixels and channels of |(d - d') - (t - t')|: d, t the decoded and the true value, d',
                              t' those of the previous image; NaN for the first image */
} adcgs_temporal_view;

/** Result of all images together. Variances are per pixel and channel, over n images divided by n, then averaged. */
typedef struct adcgs_temporal_total {
    uint32_t views;
    double dynamic_share;   /**< of all pixels, 0..1 */
    double static_variance; /**< of the decoded static pixels; NaN without static pixels, as the next */
    double truth_variance;  /**< of the true ones: mostly noise of the camera */
} adcgs_temporal_total;

adcgs_status adcgs_temporal_create(adcgs_temporal **out, int width, int height, adcgs_error *error);
void adcgs_temporal_free(adcgs_temporal **temporal);
/** Add a true image, once each, in any order; then find the region. */
void adcgs_temporal_look(adcgs_temporal *temporal, const float *truth);
adcgs_status adcgs_temporal_find_region(adcgs_temporal *temporal, adcgs_error *error);
/** [height][width], 1 in the dynamic region, else 0. */
const uint8_t *adcgs_temporal_region(const adcgs_temporal *temporal);
/** Compare the images, which must come in ascending time. */
adcgs_temporal_view adcgs_temporal_add(adcgs_temporal *temporal, const float *decoded, const float *truth);
adcgs_temporal_total adcgs_temporal_end(const adcgs_temporal *temporal);

#endif
