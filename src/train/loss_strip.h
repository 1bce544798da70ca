/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What one unit of the loss is: a strip of columns of one channel, and the kernels that work on it. */
#ifndef ADCGS_TRAIN_LOSS_STRIP_H
#define ADCGS_TRAIN_LOSS_STRIP_H

/** Columns of a strip at most: its rings of rows then fit the first-level cache. */
#define ADCGS_LOSS_STRIP 128
#define ADCGS_LOSS_HALO 5
/** Floats of a row buffer: a strip with two halos on both sides, in whole vectors. */
#define ADCGS_LOSS_ROW (ADCGS_LOSS_STRIP + 32)
/** Floats of scratch space per thread: rings of 11 rows of 4 and 3 maps, 10 single rows. */
#define ADCGS_LOSS_SCRATCH ((11 * 7 + 10) * ADCGS_LOSS_ROW)

typedef struct adcgs_loss_strip {
    const float *image, *target; /**< [height][stride], one channel */
    float *grad;
    int stride, width, height;   /**< of the image; stride is its width */
    int first, count;            /**< columns of the strip */
    float l1_scale, ssim_scale;  /**< factors of the two gradients */
    double l1, mse, ssim;        /**< out: sums over the strip's pixels */
} adcgs_loss_strip;

/** scratch: [ADCGS_LOSS_SCRATCH], 64-byte aligned. All variants give the same bits. */
typedef void (*adcgs_loss_strip_fn)(adcgs_loss_strip *strip, float *scratch);

void adcgs_loss_strip_scalar(adcgs_loss_strip *strip, float *scratch);
void adcgs_loss_strip_avx2(adcgs_loss_strip *strip, float *scratch);
void adcgs_loss_strip_avx512(adcgs_loss_strip *strip, float *scratch);

#endif
