/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Kernels of the trainer over groups of 64 anchors, chosen by CPU level. All
 * tiles are feature-major [feature][64] and 64-byte aligned. Gradients
 * accumulate unless a comment says otherwise.
 */
#ifndef ADCGS_TRAIN_DSP_H
#define ADCGS_TRAIN_DSP_H

#include "splat/dense.h"

/** Outputs of F_theta per primitive, of F_omega per anchor, of F_varpi per primitive. */
enum { ADCGS_THETA_OUT = 14, ADCGS_OMEGA_OUT = 12, ADCGS_VARPI_OUT = 4 };

/** One group of 64 anchors on its way to 64*k primitives. */
typedef struct adcgs_group_io {
    int k;
    const float *x;      /**< [3][64] anchor positions */
    const float *sigma;  /**< [6][64] */
    const float *colour; /**< [3][64] */
    const float *theta;  /**< [k][14][64] */
    const float *omega;  /**< [12][64] (9 used without rotation) or NULL */
    const float *varpi;  /**< [4k][64] or NULL */
    const float *moving; /**< [64] 1 for moving, 0 for static anchors; read when omega or varpi is given */
    const float *keep;   /**< [k][64] 1 for primitives that exist, else 0 */
    int rotation;        /**< omega's outputs 9..11 are used */
    float *mean[3], *scale[3], *rot[4], *opacity, *rgb[3]; /**< [k][64] each */
} adcgs_group_io;

/** Gradients of the same: in from the rasteriser, out to the networks. */
typedef struct adcgs_group_grad {
    const float *mean[3], *scale[3], *rot[4], *opacity, *rgb[3]; /**< [k][64] */
    float *sigma, *colour;        /**< [6][64], [3][64], accumulated */
    float *theta, *omega, *varpi; /**< overwritten; omega, varpi may be NULL as above */
} adcgs_group_grad;

typedef struct adcgs_train_dsp {
    adcgs_dense_dsp dense;
    /**
     * gw[o][i] += sum over tiles and lanes of dy[o]*x[i]; gb[o] += sum of dy[o] (gb may be NULL).
     * Tile t: dy + t*sy, x + t*sx.
     */
    void (*weight_grad)(float *gw, size_t ldg, float *gb, const float *dy, size_t sy, const float *x, size_t sx, int tiles,
                        int n_out, int n_in);
    /** dz[i] *= h[i] < 0 ? 2^-6 : 1 over n rows of 64; h: the leaky ReLU's output, whose sign is its input's. */
    void (*lrelu_back)(float *dz, const float *h, int n);
    /** y = p + step[row] * u, u uniform in [-1/2, 1/2) from (seed, position): additive quantisation noise, n rows of 64. */
    void (*noise)(float *y, const float *p, const float *step, int n, uint32_t seed);
    /** y = step*(rint(p/step - mu/64) + mu/64): straight-through rounding around the predicted mean (mu in 1/64 step). */
    void (*round)(float *y, const float *p, const float *step, const float *mu, int n);
    void (*primitives)(const adcgs_group_io *io);
    void (*primitives_back)(const adcgs_group_io *io, const adcgs_group_grad *grad);
    /**
     * Bits of n rows of 64 values and their gradients. y: values; step: [n]; mu: [n][64] in 16 steps; si: [n][64] in 8 sigma
     * levels around level 32; weight: [64] of each lane (0 for padding). dy += scale*dbits/dy; dmu, dsi overwritten with
     * scale*dbits/dmu, /dsi. Returns the weighted sum of bits.
     */
    double (*rate)(const float *y, const float *step, const float *mu, const float *si, const float *weight, int n, float scale,
                   float *dy, float *dmu, float *dsi);
    /** Adam step on n parameters; c1 = 1/(1-beta1^t), c2 = 1/(1-beta2^t); clears g. */
    void (*adam)(float *p, float *g, float *m, float *v, size_t n, float lr, float c1, float c2);
} adcgs_train_dsp;

/** Gains between the entropy twins' outputs and the coder's quantities; the integer networks reproduce them by their shifts. */
#define ADCGS_MU_GAIN 16.0f
#define ADCGS_SI_GAIN 8.0f
#define ADCGS_SI_CENTRE 32.0f

void adcgs_train_dsp_init(adcgs_train_dsp *dsp, adcgs_cpu_level level);

#endif
