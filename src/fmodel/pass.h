/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * One pass through the float model: from parameters and a time to primitives, and from gradients of primitives (and of the rate)
 * back to parameters. Deterministic for any number of threads: groups are divided into a fixed number of chunks, whose network
 * gradients are merged in order.
 */
#ifndef ADCGS_FMODEL_PASS_H
#define ADCGS_FMODEL_PASS_H

#include "base/thread_pool.h"
#include "fmodel/fmodel.h"
#include "grad/raster.h"

/** The networks' view of the anchors' parameters. */
typedef enum adcgs_quant {
    ADCGS_QUANT_NONE,  /**< the parameters */
    ADCGS_QUANT_NOISE, /**< parameters plus uniform noise of one step */
    ADCGS_QUANT_ROUND, /**< rounded around adcgs_pass.mu, in steps times adcgs_pass.factor; straight-through gradient */
} adcgs_quant;

typedef struct adcgs_pass {
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
    adcgs_train_dsp dsp, bf16;  /**< bf16: with layers in bf16, if this CPU supports it */
    const adcgs_train_dsp *net; /**< kernels of F_theta, F_omega, F_varpi since the last forward pass */
    uint32_t groups;
    float *used[ADCGS_P_ANCHOR]; /**< the networks' input, laid out as the parameters */
    float *mu[ADCGS_P_ANCHOR];   /**< predicted means for ADCGS_QUANT_ROUND, packed */
    float *factor;               /**< [groups][steps][64] of adaptive steps; steps: adcgs_params_steps(). Used like mu */
    adcgs_quant quant;           /**< of the last forward pass */
    adcgs_rate_table *table;     /**< the coder's costs */
    float *keep;                 /**< the model's keep without dropped-out primitives: [slots] */
    float *act;                  /**< activations, act_stride floats per group */
    size_t act_stride;
    float *scratch; /**< scratch_stride floats per thread */
    size_t scratch_stride;
    float *partial; /**< network gradients, partial_stride per chunk */
    size_t partial_stride, partial_at[ADCGS_P_COUNT];
    int chunks;
    double *bits; /**< [chunk][ADCGS_GROUPS] estimated bits of the last backward pass */
    float *prim;  /**< primitives: [ADCGS_ROWS][slots] */
    float *grad;  /**< their gradients: [ADCGS_GRAD_ROWS][slots] */
    adcgs_primitives primitives;
    adcgs_raster_grads grads;
    const float *pull; /**< added to the gradient of the anchors' translations and rotations, [group][12][64] or NULL */
    float *time_code;  /**< columns of the time table at t: f_t, and poses */
    adcgs_body_place pose[ADCGS_BODIES_MAX]; /**< of the bodies at t */
    size_t partial_bodies;                   /**< offset of a chunk's sums for the bodies' poses, [bodies] of adcgs_body_grad */
    float *time_bias[2];                     /**< first-layer bias of omega, varpi at this time */
    float t;
} adcgs_pass;

/** Bits of the coded values: eta, f_v, Sigma_v and C_v, which form layer 0, and the chunks of f_g, which form the others. */
typedef struct adcgs_rate {
    double bits[ADCGS_GROUPS];
    double total;
} adcgs_rate;

adcgs_status adcgs_pass_create(adcgs_pass **out, const adcgs_fmodel *f, adcgs_cpu_level cpu, adcgs_pool *pool,
                               adcgs_error *error);
void adcgs_pass_free(adcgs_pass **pass);
/** Reallocates after a change of the number of anchors. */
adcgs_status adcgs_pass_resize(adcgs_pass *pass, const adcgs_fmodel *f, adcgs_error *error);

/** The deformation networks in use. */
typedef enum adcgs_deform { ADCGS_DEFORM_NONE, ADCGS_DEFORM_ALL, ADCGS_DEFORM_COARSE } adcgs_deform;

/** Mode of a forward pass in training. Zero-initialised: as in playback. */
typedef struct adcgs_pass_mode {
    adcgs_quant quant;
    adcgs_deform deform;
    int bf16;       /**< 1: rendering networks run in bf16, here and in the backward pass; entropy networks never do */
    float dropout;  /**< share of primitives dropped at random, so that the rest does not rely on any of them */
    uint32_t seed;  /**< of noise and dropout */
    int other_time; /**< 1: only the time differs from the last pass, so the outputs of F_theta are reused */
} adcgs_pass_mode;

/** Computes the primitives at t in [0,1] into pass->primitives. */
void adcgs_pass_forward(adcgs_pass *pass, const adcgs_fmodel *f, float t, const adcgs_pass_mode *mode);

/**
 * Adds gradients of pass->grads to f->param[].g. With adaptive steps, the gradients of the anchors must be 0 before. With
 * rate_scale > 0 also adds the gradient of rate_scale * bits, measured on every `period`-th group starting at `first` and scaled
 * up. rate, if not NULL, receives the estimate for all anchors. After a rounding pass, these bits are the coder's own, for values
 * rounded around the current means.
 */
void adcgs_pass_backward(adcgs_pass *pass, adcgs_fmodel *f, adcgs_deform deform, float rate_scale, int period, int first,
                         adcgs_rate *rate);

/**
 * The coder's bits of all anchors for rounded values, without flags and framing. The networks must be on their lattices;
 * gradients are unchanged.
 */
void adcgs_pass_rate(adcgs_pass *pass, adcgs_fmodel *f, adcgs_rate *rate);

#endif
