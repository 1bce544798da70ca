/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Quality of what moves in one picture, where a mask says what that is: the mask is known truth, of any camera. */
#ifndef ADCGS_METRIC_MOVING_H
#define ADCGS_METRIC_MOVING_H

#include "base/base.h"

typedef struct adcgs_moving {
    double psnr;  /**< dB, over the pixels that move; not a number if none does */
    double share; /**< of the picture's pixels, 0..1 */
} adcgs_moving;

/**
 * Compare pictures, planar [3][plane], range 0..1, where moving [plane] is not 0. Pixels in which the truth is not a number are
 * not known: these are not taken for moving.
 */
adcgs_moving adcgs_moving_measure(const uint8_t *moving, const float *decoded, const float *truth, size_t plane);

#endif
