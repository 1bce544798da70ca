/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The central type: adcgs_model is exactly the numbers that one time segment
 * of a stream carries, and nothing else (decision D1). The trainer produces
 * one; the writer serialises it; the reader returns an equal one; primitives
 * and frames are derived from it alone.
 */
#ifndef ADCGS_MODEL_MODEL_H
#define ADCGS_MODEL_MODEL_H

#include "base/base.h"
#include "bits/bytes.h"
#include "net/net.h"

#define ADCGS_K_MAX 16
#define ADCGS_NV_MAX 64
#define ADCGS_NG_MAX 32
#define ADCGS_CHUNKS_MAX 4
#define ADCGS_ETA_MAX 8
#define ADCGS_OCTAVES_MAX 10
#define ADCGS_SIGMA_N 6
#define ADCGS_SPAN_N 5
#define ADCGS_SIGMA_MAX (ADCGS_SIGMA_N + ADCGS_SPAN_N)
#define ADCGS_COLOUR_N 3
#define ADCGS_BODIES_MAX 15
#define ADCGS_POSE_N 7
#define ADCGS_LAYERS 5
#define ADCGS_TIERS_MAX 8
#define ADCGS_GROWTH_MAX 16
#define ADCGS_ANCHORS_MAX (1U << 20)
#define ADCGS_TIME_ROWS_MAX 4096
#define ADCGS_TIME_WIDTH_MAX 512

/** Channel groups whose latents are coded together. */
typedef enum adcgs_group {
    ADCGS_GROUP_ETA = 0,
    ADCGS_GROUP_FV = 1,
    ADCGS_GROUP_SIGMA = 2,
    ADCGS_GROUP_COLOUR = 3,
    ADCGS_GROUP_FG = 4, /**< 4 + chunk */
    ADCGS_GROUPS = 8
} adcgs_group;

/** Sizes and switches, the same for all segments of a stream. */
typedef struct adcgs_params {
    uint8_t k;               /**< primitives per anchor, 1..16 */
    uint8_t n_fv;            /**< N_v: channels of f_v, 1..64 */
    uint8_t n_fg;            /**< N_g: channels of f_g per primitive, 0..32, a multiple of chunks */
    uint8_t chunks;          /**< M: 1..4 */
    uint8_t n_eta;           /**< channels of the hyper-latent, 0..8; 0: f_v has a factorised prior */
    uint8_t octaves;         /**< octaves of the position code f_p, 0..10: f_p has 6*octaves values */
    uint8_t fine_uses_fv;    /**< F_varpi's static inputs are [f_p, f_v] instead of f_p */
    uint8_t coarse_rotation; /**< F_omega also predicts a rotation of the anchor */
    uint8_t adaptive_steps;  /**< E_q adapts all steps except that of f_v to the anchor */
    uint8_t spans;           /**< moving anchors have a lifetime and a velocity, channels 6.. of Sigma_v */
    uint8_t bodies;          /**< rigid bodies, 0..15, whose poses are the last columns of Z; 0 without a time table */
    uint8_t smooth_time;     /**< the time code is a spline of the rows of Z, not linear between rows */
    uint16_t time_rows;      /**< rows of Z; 0: the scene is static, no deformation networks */
    uint16_t time_width;     /**< columns of Z that are f_t; adcgs_pose_columns() more follow */
} adcgs_params;

typedef struct adcgs_model {
    adcgs_params params;
    double time_start, time_end; /**< seconds; end >= start */
    double reach; /**< seconds after the end that the model still covers, for the crossfade into the next segment; 0: none */

    uint32_t n;      /**< anchors, >= 1 */
    uint8_t depth;   /**< 0..21 */
    float origin[3]; /**< scene units: corner of voxel (0,0,0) */
    float voxel;     /**< scene units: edge of a voxel, > 0 */
    uint32_t *pos;   /**< [n][3], Morton order, distinct */

    uint8_t *is_static; /**< [n] 1: the anchor is not deformed */
    uint8_t *body;      /**< [n] the rigid body that the anchor follows, 1..bodies; 0: none, as for static anchors */
    uint16_t *mask;     /**< [n] bit k: primitive k exists */
    uint8_t *tier;      /**< [n] tier (set of anchors), 0..finest; the first is a coarse image of the whole scene */

    /* Reconstructed latents yq in 1/64 step, |yq| <= 32767. Primitives that do not exist have f_g = 0. */
    int16_t *eta;    /**< [n][n_eta] */
    int16_t *fv;     /**< [n][n_fv] */
    int16_t *sigma;  /**< [n][6]: log extents of offsets xyz, log base scales xyz; with spans [n][11]: see adcgs_span_channel */
    int16_t *colour; /**< [n][3] */
    int16_t *fg;     /**< [n][k][n_fg]; chunk c is channels [c*n_fg/chunks, (c+1)*n_fg/chunks) */

    /* value = (float)yq * (d * factor), d = step/64, normal binary32 in [2^-40, 2^10]; factor: splat/steps.h */
    float d_fv[ADCGS_NV_MAX], d_sigma[ADCGS_SIGMA_MAX], d_colour[ADCGS_COLOUR_N], d_fg[ADCGS_NG_MAX];
    int16_t eta_mu[ADCGS_ETA_MAX]; /**< prior of eta, 1/64 step */
    uint8_t eta_si[ADCGS_ETA_MAX];

    uint8_t finest; /**< tiers after the first, 0..ADCGS_TIERS_MAX - 1; in a model that is not predicted, each has an anchor */
    /** [finest] 0..16: primitives are 2^(growth/8) times as large while all tiers after this one are absent */
    uint8_t growth[ADCGS_TIERS_MAX - 1];

    adcgs_net net[ADCGS_ROLES];
    uint8_t absent;    /**< number of absent tiers, the finest ones; not part of equality or digest of a complete model */
    uint8_t predicted; /**< coded relative to the segment before; not part of equality or digest */
    uint8_t layers;    /**< layers decoded for this model, 1..5; not part of equality or digest of a complete model */
} adcgs_model;

/** Allocate the per-anchor arrays for n anchors (n, params set by the caller first). */
adcgs_status adcgs_model_alloc(adcgs_model *model, adcgs_memory *memory, adcgs_error *error);
/** Deep copy; on failure, adcgs_model_clear() frees the contents of dst. */
adcgs_status adcgs_model_copy(adcgs_model *dst, const adcgs_model *src, adcgs_memory *memory, adcgs_error *error);
void adcgs_model_clear(adcgs_model *model, adcgs_memory *memory);
/**
 * Tiers (spec clause "Tiers"). adcgs_model_tier(): the anchors of one tier alone. adcgs_model_coarser(): the model with only the
 * first `tiers` tiers, at least 1. The caller clears dst, also on failure.
 */
adcgs_status adcgs_model_tier(adcgs_model *dst, const adcgs_model *src, int tier, adcgs_memory *memory, adcgs_error *error);
adcgs_status adcgs_model_coarser(adcgs_model *dst, const adcgs_model *src, int tiers, adcgs_memory *memory, adcgs_error *error);
/** ADCGS_ERR_DATA if an added anchor has the place of an existing one, of an earlier tier or kept. */
adcgs_status adcgs_tiers_check(const adcgs_model *coarser, const adcgs_model *added, adcgs_error *error);
/** Join the anchors of the earlier tiers with those of model, in model. */
adcgs_status adcgs_tiers_join(const adcgs_model *coarser, adcgs_model *model, adcgs_memory *memory, adcgs_error *error);
/** Check everything that a decoder relies on: shapes, ranges, network sizes against params; E24 bounds; finite steps. */
adcgs_status adcgs_model_validate(const adcgs_model *model, adcgs_error *error);
/** Byte-for-byte equality of everything that the stream carries; if they differ, error names the first difference. */
int adcgs_model_equal(const adcgs_model *a, const adcgs_model *b, adcgs_error *error);
/** MD5 of the canonical serialisation (spec "Model digest"). */
void adcgs_model_digest(const adcgs_model *model, uint8_t digest[16]);

/** Channels that spans add to Sigma_v: translation xyz from the middle of the lifetime to its end, the middle, and the logarithm
 * of the pace, which is the inverse of half the lifetime. */
enum adcgs_span_channel { ADCGS_SPAN_VELOCITY = ADCGS_SIGMA_N, ADCGS_SPAN_MIDDLE = ADCGS_SIGMA_N + 3, ADCGS_SPAN_PACE };
/** Channels of Sigma_v. */
static inline int adcgs_sigma_rows(const adcgs_params *params)
{
    return params->spans ? ADCGS_SIGMA_MAX : ADCGS_SIGMA_N;
}
/** Channels of an anchor that are coded. Static anchors have no lifetime; those channels are 0. */
static inline int adcgs_sigma_coded(const adcgs_model *model, uint32_t anchor)
{
    return model->params.time_rows && !model->is_static[anchor] ? adcgs_sigma_rows(&model->params) : ADCGS_SIGMA_N;
}

/** Inputs of F_theta that select one of an anchor's primitives: 1 for that primitive, 0 for the others. */
static inline int adcgs_slot_inputs(const adcgs_params *params)
{
    return params->k > 1 ? params->k : 0;
}

/** Columns of Z that are poses: per body a quaternion less the identity, then a translation, all times 16 (ADCGS_POSE_SCALE). */
static inline uint32_t adcgs_pose_columns(const adcgs_params *params)
{
    return (uint32_t)params->bodies * ADCGS_POSE_N;
}
#define ADCGS_POSE_SCALE 0x1p-4f
/** Index at which a body's pose begins in a row of Z; body counts from 1. */
static inline uint32_t adcgs_pose_at(const adcgs_params *params, int body)
{
    return params->time_width + (uint32_t)(body - 1) * ADCGS_POSE_N;
}

/** Expected n_in, n_out of a role's network under params; 0,0 if params have no such role. */
void adcgs_role_shape(const adcgs_params *params, int role, uint32_t *n_in, uint32_t *n_out);

/**
 * Maximum number of groups of channels whose steps adapt to the anchor: Sigma_v, C_v, chunks of f_g; f_v has none. Each group has
 * an index q of its own in -16..16, in eighths of an octave.
 */
#define ADCGS_STEPS_MAX (2 + ADCGS_CHUNKS_MAX)
#define ADCGS_STEP_INDEX_MAX 16
/** Number of such groups under the parameters; 0 without adaptive steps. */
int adcgs_params_steps(const adcgs_params *params);
static inline int adcgs_group_steps(int group)
{
    return group - ADCGS_GROUP_SIGMA;
}

#endif
