/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * One trip through the float model: from parameters and a time to primitives,
 * and from gradients of primitives (and of the rate) back to parameters.
 * Deterministic at any thread count: groups are cut into a fixed number of
 * chunks whose network gradients are merged in order.
 */
#ifndef ADCGS_TRAIN_PASS_H
#define ADCGS_TRAIN_PASS_H

#include "base/pool.h"
#include "train/fmodel.h"
#include "train/raster.h"

/** What the networks see of the anchors' parameters. */
typedef enum adcgs_quant {
    ADCGS_QUANT_NONE,  /**< the parameters */
    ADCGS_QUANT_NOISE, /**< parameters plus uniform noise of one step */
    ADCGS_QUANT_ROUND, /**< rounded around the means in adcgs_pass.mu, gradients straight through */
} adcgs_quant;

typedef struct adcgs_pass {
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
    adcgs_train_dsp dsp;
    uint32_t groups;
    float *used[ADCGS_P_ANCHOR]; /**< what the networks see, laid out as the parameters */
    float *mu[ADCGS_P_ANCHOR];   /**< predicted means in 1/64 step for ADCGS_QUANT_ROUND */
    float *keep;                 /**< the model's keep, less what was dropped out: [slots] */
    float *act;                  /**< activations, act_stride floats per group */
    size_t act_stride;
    float *scratch;              /**< scratch_stride floats per thread */
    size_t scratch_stride;
    float *partial;              /**< network gradients, partial_stride per chunk */
    size_t partial_stride, partial_at[ADCGS_P_COUNT];
    int chunks;
    double *bits;                /**< [chunk][5 streams] estimated bits of the last backward pass */
    float *prim;                 /**< primitives: 14 arrays of slots */
    float *grad;                 /**< their gradients and statistics: 16 arrays */
    adcgs_primitives primitives;
    adcgs_raster_grads grads;
    float *time_code;            /**< f_t */
    float *time_bias[2];         /**< first-layer bias of omega, varpi at this time */
    float t;
} adcgs_pass;

/** Bits per anchor group of parameters: f_v, f_g, sigma, colour, eta. */
typedef struct adcgs_rate {
    double bits[ADCGS_P_ANCHOR];
    double total;
} adcgs_rate;

adcgs_status adcgs_pass_create(adcgs_pass **out, const adcgs_fmodel *f, adcgs_cpu_level cpu, adcgs_pool *pool,
                               adcgs_error *error);
void adcgs_pass_free(adcgs_pass **pass);
/** After the number of anchors changed. */
adcgs_status adcgs_pass_resize(adcgs_pass *pass, const adcgs_fmodel *f, adcgs_error *error);

/** How a forward pass differs from playing the model. Zero-initialise for playing. */
typedef struct adcgs_pass_mode {
    adcgs_quant quant;
    int deform;    /**< 0 leaves the deformation networks out */
    float dropout; /**< share of primitives left out at random: what remains may not rely on any one of them */
    uint32_t seed; /**< of noise and dropout */
} adcgs_pass_mode;

/** Primitives at t in [0,1] into pass->primitives. */
void adcgs_pass_forward(adcgs_pass *pass, const adcgs_fmodel *f, float t, const adcgs_pass_mode *mode);

/**
 * Accumulate gradients of pass->grads into f->param[].g. With rate_scale > 0 add the gradient of rate_scale * bits, measured on
 * every `period`-th group starting at `first` and scaled up; rate, if not NULL, receives the estimate for all anchors.
 */
void adcgs_pass_backward(adcgs_pass *pass, adcgs_fmodel *f, int deform, float rate_scale, int period, int first,
                         adcgs_rate *rate);

#endif
