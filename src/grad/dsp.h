/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Kernels of the trainer over groups of 64 anchors, chosen by CPU level. All
 * tiles are feature-major [feature][64] and 64-byte aligned. Gradients
 * accumulate unless a comment says otherwise.
 */
#ifndef ADCGS_GRAD_DSP_H
#define ADCGS_GRAD_DSP_H

#include "splat/dense.h"

#include <math.h>

/** Outputs of F_theta per primitive, of F_omega per anchor, of F_varpi per primitive; definition of the format. */
enum { ADCGS_THETA_OUT = 14, ADCGS_OMEGA_OUT = 12, ADCGS_VARPI_OUT = 4 };

/** Pose of a rigid body at a time: x maps to R(q) (x - centre) + to. */
typedef struct adcgs_body_place {
    float q[4], centre[3], to[3];
} adcgs_body_place;
/**
 * Gradients of a body's pose, summed over its anchors: of the rotation matrix, which moves positions; of the quaternion, which
 * rotates primitives; of the translation.
 */
typedef struct adcgs_body_grad {
    float m[9], q[4], way[3];
} adcgs_body_grad;

/** One group of 64 anchors and its 64*k primitives. */
typedef struct adcgs_group_io {
    int k;
    const float *x;     /**< [3][64] anchor positions */
    const float *sigma; /**< [6][64]; with lifetimes [11][64] */
    int spans;          /**< 1: lifetimes are in use, at time t */
    float t;
    const float *colour;          /**< [3][64] */
    const float *theta;           /**< [k][14][64] */
    const float *omega;           /**< [12][64] (9 used without rotation) or NULL */
    const float *varpi;           /**< [4k][64] or NULL */
    const float *moving;          /**< [64] 1 for moving, 0 for static anchors; read when omega or varpi is given, or spans */
    const float *keep;            /**< [k][64] 1 for primitives that exist, else 0 */
    int rotation;                 /**< omega's outputs 9..11 are used */
    const uint8_t *body;          /**< [64] rigid body of a moving anchor, from 1; 0: none; or NULL */
    const adcgs_body_place *pose; /**< [bodies] */
    float *mean[3], *scale[3], *rot[4], *opacity, *rgb[3]; /**< [k][64] each */
} adcgs_group_io;

/** Gradients of the same: input from the rasteriser, output for the networks. */
typedef struct adcgs_group_grad {
    const float *mean[3], *scale[3], *rot[4], *opacity, *rgb[3]; /**< [k][64] */
    float *sigma, *colour;                                       /**< as io's, accumulated */
    float *theta, *omega, *varpi;                                /**< overwritten; omega, varpi may be NULL as above */
    const float *pull;     /**< [12][64] additional gradient of omega's translation and rotation matrix, or NULL */
    adcgs_body_grad *body; /**< [bodies], accumulated; if io has bodies */
} adcgs_group_grad;

/** Cost of a value of magnitude `a` at a sigma level, by the coder's tables. */
typedef struct adcgs_rate_cell {
    float bits;     /**< coded bits; at level 0 nothing is coded */
    float by_value; /**< derivative with respect to the magnitude */
    float by_level; /**< derivative with respect to the level */
} adcgs_rate_cell;

/**
 * Largest magnitude of a quantised value in training; one more cell, so that a value may lie between two cells. Steps; chosen by
 * hand, not measured: more than twice the half-support of the coder's tables.
 */
enum { ADCGS_LEVEL_MAX = 500, ADCGS_RATE_CELLS = ADCGS_LEVEL_MAX + 2 };
typedef struct adcgs_rate_table {
    adcgs_rate_cell cell[ADCGS_SIGMA_LEVELS][ADCGS_RATE_CELLS];
} adcgs_rate_table;
void adcgs_rate_table_init(adcgs_rate_table *table);

/** Rows of 64 values to code, with an entropy network's outputs. */
typedef struct adcgs_rate_io {
    int n;
    const float *y, *step; /**< values [n][64], steps [n] */
    const float *mu, *si;  /**< the network's outputs: [n][64] in 16 steps, [n][64] in 8 sigma levels around level 32 */
    const float *weight;   /**< [64] of each lane, 0 for padding */
    float scale;
    float *dy, *dmu, *dsi;         /**< dy += scale*dbits/dy; dmu, dsi overwritten with scale*dbits/dmu, /dsi */
    float *x;                      /**< receives the values as inputs of later networks; may be NULL */
    const adcgs_rate_table *table; /**< rate_exact: the coder's */
    float *mean;                   /**< rate_exact: receives the means, packed */
} adcgs_rate_io;

/** Weights of a residual layer, [n][n], and their form after adcgs_train_dsp.pack, if that exists. */
typedef struct adcgs_square {
    int n;
    const float *w;
    const uint32_t *packed;
} adcgs_square;

/** Words of a packed square. */
static inline size_t adcgs_square_words(int n)
{
    return (size_t)n * (((size_t)n + 31) / 32 * 16);
}

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
    /**
     * A residual hidden layer: with z = bias + w x, h = x + leaky ReLU of z. Bit l of below[o]: lane l of z[o] is negative. dsp:
     * these kernels.
     */
    void (*residual)(const struct adcgs_train_dsp *dsp, float *h, uint64_t *below, const float *bias, const adcgs_square *w,
                     const float *x);
    /**
     * Backward: dz = dh times the leaky ReLU's slope, dx = dh + turn dz; turn: w transposed. dx may be dh. io: NULL, or the
     * layer's x followed by its h, which the weight gradients need next, for prefetching.
     */
    void (*residual_back)(const struct adcgs_train_dsp *dsp, float *dx, float *dz, const uint64_t *below,
                          const adcgs_square *turn, const float *dh, const float *io);
    /** Packs weights [n][n] into adcgs_square_words(n) aligned words for the two functions above; NULL if they need none. */
    void (*pack)(uint32_t *to, const float *w, int n);
    /** y = p + step[row] * u, u uniform in [-1/2, 1/2) from (seed, position): additive quantisation noise, n rows of 64. */
    void (*noise)(float *y, const float *p, const float *step, int n, uint32_t seed);
    /** y: the coder's value of p, rounded in steps around the predicted mean mu; see adcgs_mean_pack(). */
    void (*round)(float *y, const float *p, const float *step, const float *mu, int n);
    void (*primitives)(const adcgs_group_io *io);
    void (*primitives_back)(const adcgs_group_io *io, const adcgs_group_grad *grad);
    /**
     * n rows of a hidden layer: h = leaky ReLU of z, plus `in` unless NULL; below as in residual. hidden_exact, for entropy
     * networks: z and in are on the integer networks' lattices, and h is their exact result.
     */
    void (*hidden)(float *h, uint64_t *below, const float *z, const float *in, int n);
    void (*hidden_exact)(float *h, uint64_t *below, const float *z, const float *in, int n);
    /**
     * Bits of values and their gradients; returns the weighted sum of bits. rate: of noisy values under a Gaussian. rate_exact:
     * as in the coder, with gradients straight through every rounding.
     */
    double (*rate)(const adcgs_rate_io *io);
    double (*rate_exact)(const adcgs_rate_io *io);
    /**
     * Adam step on n parameters; c1 = 1/(1-beta1^t), c2 = 1/(1-beta2^t); clears g. No step is longer than lr: when gradients grow
     * suddenly, as at an increase of the image size, their mean square lags for a thousand steps.
     */
    void (*adam)(float *p, float *g, float *m, float *v, size_t n, float lr, float c1, float c2);
} adcgs_train_dsp;

/**
 * Gains between the entropy twins' outputs and the coder's quantities; the integer networks reproduce them by their shifts;
 * definition of the format.
 */
#define ADCGS_MU_GAIN 16.0f
#define ADCGS_SI_GAIN 8.0f
#define ADCGS_SI_CENTRE 32.0f
/** The output of E_q's twin is in octaves, of the integer network in eighths of octaves; definition. */
#define ADCGS_STEP_GAIN 8.0f

/**
 * The integer networks in the twins' units. Weights, biases and activations are multiples of 2^-ADCGS_E24_BITS; weights and
 * activations are at most ADCGS_E24_MAX of them. Inputs are values in units of 16 steps, and multiples of a quarter of a step.
 * Definition of the format.
 */
enum { ADCGS_E24_BITS = 6, ADCGS_E24_MAX = 2047, ADCGS_E24_INPUT_SHIFT = 4 };

/** x clamped to [lo, hi]; lo for NaN. */
static inline float adcgs_bounded(float x, float lo, float hi)
{
    const float y = x > lo ? x : lo;
    return y < hi ? y : hi;
}
/** A mean in 1/64 step as stored by the passes: marked if the sigma level is 0, at which only the mean is coded; definition. */
#define ADCGS_MEAN_ALONE 0x1p18f
static inline float adcgs_mean_pack(float mean, int alone)
{
    return alone ? mean + ADCGS_MEAN_ALONE : mean;
}
static inline int adcgs_mean_alone(float packed)
{
    return packed > 0.5f * ADCGS_MEAN_ALONE;
}

/** The coder's values of the twins' outputs: the mean in 1/64 step, the sigma level. */
static inline float adcgs_coder_mean(float mu)
{
    return adcgs_bounded(floorf(64 * ADCGS_MU_GAIN * mu + 0.5f), -32767, 32767);
}
static inline float adcgs_coder_level(float si)
{
    return adcgs_bounded(floorf(ADCGS_SI_GAIN * si + 0.5f) + ADCGS_SI_CENTRE, 0, ADCGS_SIGMA_LEVELS - 1);
}

void adcgs_train_dsp_init(adcgs_train_dsp *dsp, adcgs_cpu_level level);

/** Checks if kernels of this level support bf16: ADCGS_ERR_UNSUPPORTED names the feature that the CPU or the build lacks. */
adcgs_status adcgs_bf16_check(adcgs_cpu_level level, adcgs_error *error);
/** The kernels of a level; if the check passes, layers and weight gradients use bf16 factors and binary32 sums. */
void adcgs_train_dsp_init_bf16(adcgs_train_dsp *dsp, adcgs_cpu_level level);

#endif
