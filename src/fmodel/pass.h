/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * One trip through the float model: from parameters and a time to primitives,
 * and from gradients of primitives (and of the rate) back to parameters.
 * Deterministic at any thread count: groups are cut into a fixed number of
 * chunks whose network gradients are merged in order.
 */
#ifndef ADCGS_FMODEL_PASS_H
#define ADCGS_FMODEL_PASS_H

#include "base/pool.h"
#include "fmodel/fmodel.h"
#include "grad/raster.h"

/** What the networks see of the anchors' parameters. */
typedef enum adcgs_quant {
    ADCGS_QUANT_NONE,  /**< the parameters */
    ADCGS_QUANT_NOISE, /**< parameters plus uniform noise of one step */
    ADCGS_QUANT_ROUND, /**< rounded around the means in adcgs_pass.mu, in steps times adcgs_pass.factor, straight through */
} adcgs_quant;

typedef struct adcgs_pass {
    adcgs_cpu_level cpu;
    adcgs_pool *pool;
    adcgs_train_dsp dsp, bf16;   /**< bf16: with layers in bf16, where this CPU can */
    const adcgs_train_dsp *net;  /**< of these, those of F_theta, F_omega, F_varpi since the last forward pass */
    uint32_t groups;
    float *used[ADCGS_P_ANCHOR]; /**< what the networks see, laid out as the parameters */
    float *mu[ADCGS_P_ANCHOR];   /**< predicted means for ADCGS_QUANT_ROUND, packed */
    float *factor;               /**< [groups][steps][64] of steps that adapt; steps: adcgs_params_steps(). Read like mu */
    adcgs_quant quant;           /**< of the last forward pass */
    adcgs_rate_table *tables;    /**< the coder's costs: [ADCGS_SHAPES] */
    float *keep;                 /**< the model's keep, less what was dropped out: [slots] */
    float *act;                  /**< activations, act_stride floats per group */
    size_t act_stride;
    float *scratch;              /**< scratch_stride floats per thread */
    size_t scratch_stride;
    float *partial;              /**< network gradients, partial_stride per chunk */
    size_t partial_stride, partial_at[ADCGS_P_COUNT];
    int chunks;
    double *bits;                /**< [chunk][ADCGS_GROUPS] estimated bits of the last backward pass */
    float *prim;                 /**< primitives: [ADCGS_ROWS][slots] */
    float *grad;                 /**< their gradients: [ADCGS_GRAD_ROWS][slots] */
    adcgs_primitives primitives;
    adcgs_raster_grads grads;
    const float *pull;           /**< gradient added to that of the anchors' ways and rotations, [group][12][64]; NULL: none */
    float *time_code;            /**< columns of the time table at t: f_t, and poses */
    adcgs_body_place pose[ADCGS_BODIES_MAX]; /**< of the bodies at t */
    size_t partial_bodies;       /**< where a chunk has its sums for the bodies' poses, [bodies] of adcgs_body_grad */
    float *time_bias[2];         /**< first-layer bias of omega, varpi at this time */
    float t;
} adcgs_pass;

/** Bits of what is coded: eta, f_v, Sigma_v, C_v, which make layer 0, and the chunks of f_g, which make the others. */
typedef struct adcgs_rate {
    double bits[ADCGS_GROUPS];
    double total;
} adcgs_rate;

adcgs_status adcgs_pass_create(adcgs_pass **out, const adcgs_fmodel *f, adcgs_cpu_level cpu, adcgs_pool *pool,
                               adcgs_error *error);
void adcgs_pass_free(adcgs_pass **pass);
/** After the number of anchors changed. */
adcgs_status adcgs_pass_resize(adcgs_pass *pass, const adcgs_fmodel *f, adcgs_error *error);

/** Which deformation networks take part. */
typedef enum adcgs_deform { ADCGS_DEFORM_NONE, ADCGS_DEFORM_ALL, ADCGS_DEFORM_COARSE } adcgs_deform;

/** How a forward pass differs from playing the model. Zero-initialise for playing. */
typedef struct adcgs_pass_mode {
    adcgs_quant quant;
    adcgs_deform deform;
    int bf16;      /**< the networks that draw, here and in the backward pass, run in bf16; the entropy networks never do */
    float dropout; /**< share of primitives left out at random: what remains may not rely on any one of them */
    uint32_t seed; /**< of noise and dropout */
    int other_time; /**< only the time differs from the last pass: what F_theta makes of features is there */
} adcgs_pass_mode;

/** Primitives at t in [0,1] into pass->primitives. */
void adcgs_pass_forward(adcgs_pass *pass, const adcgs_fmodel *f, float t, const adcgs_pass_mode *mode);

/**
 * Accumulate gradients of pass->grads into f->param[].g; where steps adapt, those of the anchors have to be 0 before. With
 * rate_scale > 0 add the gradient of rate_scale * bits, measured on every `period`-th group starting at `first` and scaled up;
 * rate, if not NULL, receives the estimate for all anchors. After a pass that rounded, these bits are the coder's own for values
 * rounded around the means of now.
 */
void adcgs_pass_backward(adcgs_pass *pass, adcgs_fmodel *f, adcgs_deform deform, float rate_scale, int period, int first,
                         adcgs_rate *rate);

/**
 * The bits of all anchors as the coder would spend them on the values rounded, flags and framing aside. The networks must be
 * on their lattices; gradients stay as they are.
 */
void adcgs_pass_rate(adcgs_pass *pass, adcgs_fmodel *f, adcgs_rate *rate);

/** Give each group of channels the shape of density under which adcgs_pass_rate() is least; rate receives what it is then. */
void adcgs_pass_densities(adcgs_pass *pass, adcgs_fmodel *f, adcgs_rate *rate);

#endif
