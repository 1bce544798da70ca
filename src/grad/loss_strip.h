/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Unit of the loss: a strip of columns of one channel, and the kernels for it. */
#ifndef ADCGS_GRAD_LOSS_STRIP_H
#define ADCGS_GRAD_LOSS_STRIP_H

#define ADCGS_LOSS_HALO 5   /**< pixels: radius of the SSIM window; literature (Wang et al. 2004) */
#define ADCGS_LOSS_LANES 16 /* lanes of a vector of AVX-512; definition */
/** Maximum columns of a stripe; a strip has one stripe per lane. Arithmetic of the caches, chosen by hand, not measured. */
#define ADCGS_LOSS_STRIPE 14
#define ADCGS_LOSS_SPAN (ADCGS_LOSS_LANES * ADCGS_LOSS_STRIPE) /* columns */
/** Maximum columns of a strip: two windows in sequence need margins on both sides. */
#define ADCGS_LOSS_STRIP (ADCGS_LOSS_SPAN - 4 * ADCGS_LOSS_HALO)

typedef struct adcgs_loss_strip {
    const float *image, *target; /**< [height][width], one channel */
    float *grad;
    int width, height;                        /**< of the image */
    int first, count;                         /**< columns of the strip */
    int begin, stripe;                        /**< first column read, and columns of a stripe, an even number */
    float l1_scale, square_scale, ssim_scale; /**< factors of the gradients */
    double l1, mse, ssim;                     /**< out: sums over the strip's pixels */
} adcgs_loss_strip;

/** Rows that are kept, a power of two, and rows of a batch; arithmetic: a batch reads some rows above and below its own. */
enum { ADCGS_LOSS_RING = 32, ADCGS_LOSS_TURN = 16 };

/** A row of a strip in stripes: lane l of vector i is column l * stripe + i. */
typedef float adcgs_loss_row[ADCGS_LOSS_STRIPE][ADCGS_LOSS_LANES];
/** The same with the columns left and right of a stripe. */
typedef float adcgs_loss_wide[ADCGS_LOSS_STRIPE + 2 * ADCGS_LOSS_HALO][ADCGS_LOSS_LANES];

/** Working memory of a kernel. */
typedef struct adcgs_loss_scratch {
    _Alignas(64) float row[ADCGS_LOSS_SPAN];    /**< of the image */
    adcgs_loss_row inside, mine;                /**< 1 in columns of the image and of the strip, else 0 */
    float sums[3][ADCGS_LOSS_LANES];            /**< of a batch */
    adcgs_loss_wide pixels[ADCGS_LOSS_RING][2]; /**< ring of rows of image and target */
    adcgs_loss_wide products[2];                /**< of one row: sum of squares, product */
    adcgs_loss_row in[ADCGS_LOSS_RING][4];      /**< ring of rows of those, through the window */
    adcgs_loss_wide derivatives[ADCGS_LOSS_TURN][3];
    adcgs_loss_row out[ADCGS_LOSS_RING][3]; /**< ring of rows of those, through the window */
    adcgs_loss_row grad[ADCGS_LOSS_TURN];
} adcgs_loss_scratch;

/** All variants give the same bits. */
typedef void (*adcgs_loss_strip_fn)(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);

void adcgs_loss_strip_scalar(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);
void adcgs_loss_strip_avx2(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);
void adcgs_loss_strip_avx512(adcgs_loss_strip *strip, adcgs_loss_scratch *scratch);

#endif
