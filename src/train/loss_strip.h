/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What one unit of the loss is: a strip of columns of one channel, and the kernels that work on it. */
#ifndef ADCGS_TRAIN_LOSS_STRIP_H
#define ADCGS_TRAIN_LOSS_STRIP_H

/** Columns of a strip at most: twelve rows of its maps then fit the first-level cache. */
#define ADCGS_LOSS_STRIP 128
#define ADCGS_LOSS_HALO 5

typedef struct adcgs_loss_strip {
    const float *image, *target; /**< [height][stride], one channel */
    float *grad;
    int stride, width, height;   /**< of the image; stride is its width */
    int first, count;            /**< columns of the strip */
    float l1_scale, ssim_scale;  /**< factors of the two gradients */
    double l1, mse, ssim;        /**< out: sums over the strip's pixels */
} adcgs_loss_strip;

/** What a kernel works in, all of it vectors of sixteen. Columns begin 16, 8 and 0 before the strip's first one. */
typedef struct adcgs_loss_scratch {
    _Alignas(64) float pixels[4][ADCGS_LOSS_STRIP + 32]; /**< of a row: image, target, squares, product */
    float in[12][4][ADCGS_LOSS_STRIP + 16];              /**< ring of rows of those, through the window */
    float ssim[2][ADCGS_LOSS_STRIP + 16];                /**< of two rows */
    float derivatives[2][3][ADCGS_LOSS_STRIP + 16];      /**< of the same rows */
    float out[32][3][ADCGS_LOSS_STRIP];                  /**< ring of rows of those, through the window */
    float distance[2][ADCGS_LOSS_STRIP], square[2][ADCGS_LOSS_STRIP];
} adcgs_loss_scratch;

/** All variants give the same bits. */
typedef void (*adcgs_loss_strip_fn)(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);

void adcgs_loss_strip_scalar(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);
void adcgs_loss_strip_avx2(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);
void adcgs_loss_strip_avx512(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);

#endif
