/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The training loss of an image, value and gradient in one pass:
 *   (1 - w) ((1 - q) |e| + q e^2 / (2 ADCGS_LOSS_EVEN)) + w (1 - SSIM),
 * the mean over all values, where e is the error of a value. The absolute error settles on the median over time, which is the
 * background of a passing object. The squared error keeps its gradient where the error is large. Both have the same gradient at
 * an error of ADCGS_LOSS_EVEN. SSIM: 11x11 Gaussian window of sigma 1.5, zero padding, per channel, C1 = 0.01^2, C2 = 0.03^2 (as
 * in Wang et al. 2004 with range 1).
 */
#ifndef ADCGS_GRAD_LOSS_H
#define ADCGS_GRAD_LOSS_H

#include "base/cpu_detect.h"
#include "base/thread_pool.h"

/**
 * Error at which the absolute and the squared error have the same gradient, values of 0 to 1. Chosen by hand; measured together
 * with the share of squares (doc/log/training.md, "Squared errors for most of L1").
 */
#define ADCGS_LOSS_EVEN 0.1f

typedef struct adcgs_loss adcgs_loss;
/** w and q above, 0..1. */
typedef struct adcgs_loss_shares {
    float ssim, square;
} adcgs_loss_shares;
typedef struct adcgs_loss_value {
    double loss, l1, ssim, mse;
} adcgs_loss_value;

adcgs_status adcgs_loss_create(adcgs_loss **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_loss_free(adcgs_loss **loss);
/**
 * image, target, grad: planar [3][height][width]; grad = d loss / d image, overwritten. Deterministic for any number of threads;
 * no allocation once the workspace has grown. shares->ssim 0 skips SSIM.
 */
adcgs_status adcgs_loss_image(adcgs_loss *loss, const float *image, const float *target, int width, int height,
                              const adcgs_loss_shares *shares, float *grad, adcgs_loss_value *value, adcgs_error *error);

#endif
