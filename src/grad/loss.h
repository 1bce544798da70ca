/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The training loss of an image: (1 - w) L1 + w (1 - SSIM), value and gradient
 * in one pass. SSIM: 11x11 Gaussian window of sigma 1.5, zero padding, per
 * channel, C1 = 0.01^2, C2 = 0.03^2 (as in Wang et al. 2004 with range 1).
 */
#ifndef ADCGS_GRAD_LOSS_H
#define ADCGS_GRAD_LOSS_H

#include "base/cpu.h"
#include "base/pool.h"

typedef struct adcgs_loss adcgs_loss;
typedef struct adcgs_loss_value {
    double loss, l1, ssim, mse;
} adcgs_loss_value;

adcgs_status adcgs_loss_create(adcgs_loss **out, adcgs_cpu_level cpu, adcgs_pool *pool, adcgs_error *error);
void adcgs_loss_free(adcgs_loss **loss);
/**
 * image, target, grad: planar [3][height][width]; grad = d loss / d image, overwritten.
 * Deterministic at any thread count; no allocation once the workspace has grown. ssim_weight 0 skips SSIM.
 */
adcgs_status adcgs_loss_image(adcgs_loss *loss, const float *image, const float *target, int width, int height, float ssim_weight,
                              float *grad, adcgs_loss_value *value, adcgs_error *error);

#endif
