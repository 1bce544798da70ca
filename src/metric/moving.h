/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Quality of the moving pixels of one image, given by a mask. The mask is
 * ground truth, so the camera may move.
 */
#ifndef ADCGS_METRIC_MOVING_H
#define ADCGS_METRIC_MOVING_H

#include "base/base.h"

typedef struct adcgs_moving {
    double psnr;  /**< dB, over the moving pixels; NaN if there are none */
    double share; /**< of the image's pixels, 0..1 */
} adcgs_moving;

/**
 * Compare images, planar [3][plane], range 0..1, where moving [plane] is not 0. Pixels whose truth is NaN are unknown and not
 * counted as moving.
 */
adcgs_moving adcgs_moving_measure(const uint8_t *moving, const float *decoded, const float *truth, size_t plane);

#endif
