/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Kernels that turn network outputs into primitives, 64 lanes at a time; for splat.c alone. */
#ifndef ADCGS_SPLAT_SPLAT_ISA_H
#define ADCGS_SPLAT_SPLAT_ISA_H

#include "splat/rows.h"

/** Rows of 64 lanes for an anchor group, in addition to the networks' rows. */
typedef struct adcgs_anchor_lanes {
    _Alignas(64) float position[3][ADCGS_LANES];
    float code[3][ADCGS_LANES];                                             /**< p: position in the cube, in (0,1) */
    float extent[3][ADCGS_LANES];                                           /**< exp of Sigma_v 0..2 */
    float scale[3][ADCGS_LANES];                                            /**< exp of Sigma_v 3..5 */
    float colour[3][ADCGS_LANES];                                           /**< C_v */
    float velocity[3][ADCGS_LANES], middle[ADCGS_LANES], pace[ADCGS_LANES]; /**< lifetimes; with spans */
} adcgs_anchor_lanes;

/** Motion of a group's anchors at one time. */
typedef struct adcgs_anchor_motion {
    _Alignas(64) float position[3][ADCGS_LANES]; /**< X_v, rotated, + dX + the lifetime's motion, then moved by the body */
    float scale[3][ADCGS_LANES];                 /**< exp of dS */
    float colour[3][ADCGS_LANES];                /**< dC_v */
    float q[4][ADCGS_LANES];                     /**< qr */
    float matrix[9][ADCGS_LANES];                /**< its rotation matrix, row-major */
    float presence[ADCGS_LANES];                 /**< with spans: the weight of the lifetime, 0..1 */
} adcgs_anchor_motion;

/** Poses of the bodies of a group's anchors. Anchors without a body have the pose of any body. */
typedef struct adcgs_body_lanes {
    _Alignas(64) float q[4][ADCGS_LANES];
    float matrix[9][ADCGS_LANES];
    float centre[3][ADCGS_LANES], place[3][ADCGS_LANES];
    int32_t has[ADCGS_LANES]; /**< 1: the anchor has a body */
} adcgs_body_lanes;

/** 64 slots of one primitive index of a group: canonical values from the prediction. */
typedef struct adcgs_slot_lanes {
    _Alignas(64) float offset[3][ADCGS_LANES];
    float scale[3][ADCGS_LANES], q[4][ADCGS_LANES], colour[3][ADCGS_LANES], logit[ADCGS_LANES];
} adcgs_slot_lanes;

/** The mechanisms of a model that can move its anchors. */
typedef struct adcgs_movers {
    int coarse, rotation, spans; /**< rotation: F_omega also rotates */
} adcgs_movers;

/** present, moves: [64] 0 or 1 per lane. */
typedef struct adcgs_splat_dsp {
    /** Sigma_v values [6][64] to extent and scale; with spans [11][64]. */
    void (*anchor)(adcgs_anchor_lanes *anchor, const float *sigma, int spans);
    /** F_theta's outputs [14][64] to canonical values. */
    void (*predict)(adcgs_slot_lanes *slot, const adcgs_anchor_lanes *anchor, const float *out);
    /** Canonical primitives: without motion, as those of static anchors. */
    void (*place)(const adcgs_slot_out *to, const adcgs_slot_lanes *slot, const adcgs_anchor_lanes *anchor,
                  const int32_t *present);
    /**
     * Motion at t. out: outputs of F_omega, [9][64], or [12][64] with rotation; used only if the network exists. bodies may be
     * NULL.
     */
    void (*motion)(adcgs_anchor_motion *motion, const adcgs_anchor_lanes *anchor, const float *out, const adcgs_movers *movers,
                   const adcgs_body_lanes *bodies, float t);
    /** Primitives of moving anchors; other lanes of `to` are unchanged. bodies and fine ([4][64]) may be NULL. */
    void (*deform)(const adcgs_slot_out *to, const adcgs_slot_lanes *slot, const adcgs_anchor_motion *motion,
                   const adcgs_movers *movers, const adcgs_body_lanes *bodies, const float *fine, const int32_t *present,
                   const int32_t *moves);
    void (*position_code)(float *out, const float *x, int octaves);
} adcgs_splat_dsp;

extern const adcgs_splat_dsp adcgs_splat_scalar, adcgs_splat_avx2, adcgs_splat_avx512;

/** The kernels for a resolved level. */
void adcgs_splat_dsp_init(adcgs_splat_dsp *dsp, adcgs_cpu_level level);

#endif
