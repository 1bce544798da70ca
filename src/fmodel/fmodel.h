/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The float model in training: anchors in groups of 64, feature-major, and networks, each a parameter group with its gradient and
 * Adam moments.
 *
 * Anchor parameters are laid out [group][feature][64]; a model of n anchors has ceil(n/64) groups, the last one padded.
 */
#ifndef ADCGS_FMODEL_FMODEL_H
#define ADCGS_FMODEL_FMODEL_H

#include "fmodel/mlp.h"
#include "model/model.h"
#include "splat/rows.h"

/** Groups of trained parameters. The first five are per anchor, the rest are networks. */
typedef enum adcgs_pgroup {
    ADCGS_P_FV,
    ADCGS_P_FG, /**< [group][k][n_fg][64] */
    ADCGS_P_SIGMA,
    ADCGS_P_COLOUR,
    ADCGS_P_ETA,
    ADCGS_P_ANCHOR, /**< number of per-anchor groups */
    ADCGS_P_THETA = ADCGS_P_ANCHOR,
    ADCGS_P_OMEGA,
    ADCGS_P_VARPI,
    ADCGS_P_TIME,      /**< Z [rows][width, and poses] */
    ADCGS_P_ETA_PRIOR, /**< [2][n_eta]: mean and level of the prior, in the twins' gains */
    ADCGS_P_STEP,      /**< natural logarithms of the quantiser steps: f_v, f_g (of one primitive), Sigma_v, C_v */
    ADCGS_P_E_FV,
    ADCGS_P_E_SIGMA,
    ADCGS_P_E_COLOUR,
    ADCGS_P_E_FG,                                      /**< + chunk */
    ADCGS_P_E_STEPS = ADCGS_P_E_FG + ADCGS_CHUNKS_MAX, /**< E_q: octaves by which an anchor's steps differ */
    ADCGS_P_COUNT
} adcgs_pgroup;

/** The role of a group's network in the stream; undefined for groups without a network. */
extern const uint8_t adcgs_fmodel_role[ADCGS_P_COUNT];

/** One block of parameters. */
typedef struct adcgs_param {
    const char *name;
    size_t n;
    float *p, *g, *m, *v; /**< values, gradient, first and second moment: [n] each */
    uint32_t steps;       /**< of Adam */
    float lr0, lr1;       /**< learning rate at the first and last iteration, log-linear in between */
} adcgs_param;

/** Widths and steps of a new model. Sizes in the stream are in params. */
typedef struct adcgs_shape {
    int theta_width, theta_hidden, omega_width, omega_hidden, varpi_width, varpi_hidden, entropy_width, entropy_hidden;
    float step_fv, step_fg, step_sigma, step_colour; /**< quantiser steps */
    int depth;                                       /**< bits per axis of the position grid */
} adcgs_shape;

typedef struct adcgs_fmodel {
    adcgs_params params;
    adcgs_shape shape;
    float origin[3], voxel; /**< scene units */
    uint32_t n, groups;     /**< anchors; ceil(n/64) */
    int is_part;            /**< 1: part of a stream of several segments, whose parameters stay even if nothing moves */
    uint32_t (*pos)[3];     /**< [n] voxels, Morton order */
    float *x;               /**< [group][3][64] positions */
    float *code;            /**< [group][6*octaves][64] f_p */
    float *keep;            /**< [group][k][64] primitives that exist */
    float *moving;          /**< [group][64] 1: moving; 0: static */
    float *live;            /**< [group][64] 1 for anchors, 0 for padding */
    float *trainable;       /**< [group][64] 0: the anchor is frozen, with the values of the previous segment; 1: trained */
    int follows;            /**< 1: continues the model of the previous segment, see from_model.h */
    uint8_t *body;          /**< [group][64] rigid body of the anchor while it moves, from 1; 0: none */
    uint8_t *tier;          /**< [group][64] tier of the anchor; see train/rate/tier_assignment.h */
    uint8_t finest, growth[ADCGS_TIERS_MAX - 1]; /**< as in adcgs_model */
    float centre[ADCGS_BODIES_MAX][3];           /**< centres of rotation of the bodies; see body_trajectories.h */
    adcgs_param param[ADCGS_P_COUNT];
    adcgs_mlp mlp[ADCGS_P_COUNT]; /**< of the network groups */
    float *step[ADCGS_P_ANCHOR];  /**< quantiser steps per feature row of a group, from ADCGS_P_STEP */
} adcgs_fmodel;

/**
 * Pace of a lifetime around the middle of a segment that covers the whole segment: presence is 0.99 at its ends. Natural
 * logarithm; arithmetic: exp(-(e^-0.5 / 2)^4) = 0.99.
 */
#define ADCGS_SPAN_WHOLE (-0.5f)

/** Rows (features) per group of an anchor parameter. */
int adcgs_fmodel_rows(const adcgs_fmodel *f, int group);

/**
 * Builds networks and arrays for n anchors at pos (copied; must be distinct and in Morton order). Initial values are random, from
 * seed.
 */
adcgs_status adcgs_fmodel_create(adcgs_fmodel **out, const adcgs_params *params, const adcgs_shape *shape, const float origin[3],
                                 float voxel, const uint32_t (*pos)[3], uint32_t n, uint64_t seed, adcgs_error *error);
void adcgs_fmodel_free(adcgs_fmodel **f);

/**
 * Replaces the anchors. New anchor i at pos[i] (Morton order, distinct) is copied from old anchor source[i]: parameters and,
 * unless fresh[i], Adam moments.
 */
adcgs_status adcgs_fmodel_regroup(adcgs_fmodel *f, const uint32_t (*pos)[3], const uint32_t *source, const uint8_t *fresh,
                                  uint32_t n, adcgs_error *error);

/** True if any anchor is moving. */
static inline int adcgs_fmodel_moves(const adcgs_fmodel *f)
{
    for (uint32_t i = 0; i < f->n; i++)
        if (f->moving[i] != 0)
            return 1;
    return 0;
}

/** Slot of primitive k of an anchor, in the order of spec clause "Primitives". */
static inline size_t adcgs_fmodel_slot(const adcgs_fmodel *f, uint32_t anchor, int k)
{
    return adcgs_slot_of(anchor, f->params.k, k);
}

/** Index of a row's step in ADCGS_P_STEP. The step of eta is 1 and not stored. */
static inline int adcgs_fmodel_step_at(const adcgs_fmodel *f, int group, int row)
{
    const int nv = f->params.n_fv, ng = f->params.n_fg;
    if (group == ADCGS_P_FV)
        return row;
    if (group == ADCGS_P_FG)
        return nv + row % ng;
    return nv + ng + (group == ADCGS_P_COLOUR ? adcgs_sigma_rows(&f->params) : 0) + row;
}

/**
 * The finest step with which a stream can hold all values of a channel; for f_g, row `channel` of the first primitive. A stream
 * holds 511 steps (|yq| <= 32767 in 1/64 step), and 500 from the mean. The step uses 480 of them, as a margin for values that
 * still change.
 */
float adcgs_fmodel_finest_step(const adcgs_fmodel *f, int group, int channel);
/** Widens steps that are too fine for the values of their channel to the finest possible step. */
void adcgs_fmodel_widen_steps(adcgs_fmodel *f);
/** Updates the steps from their logarithms, which are clamped to a factor of 64 from their initial values. */
void adcgs_fmodel_take_steps(adcgs_fmodel *f);

/** One anchor's parameter row. */
static inline float *adcgs_fmodel_at(const adcgs_fmodel *f, int group, uint32_t anchor, int row)
{
    const size_t rows = (size_t)adcgs_fmodel_rows(f, group);
    return f->param[group].p + ((size_t)(anchor / ADCGS_LANES) * rows + (size_t)row) * ADCGS_LANES + anchor % ADCGS_LANES;
}

/** Presence of an anchor at t in [0,1], by its lifetime. */
float adcgs_fmodel_presence(const adcgs_fmodel *f, uint32_t anchor, float t);

/** Sets the width of a network's hidden layers, at most the shape's. The caller updates the parameters. */
void adcgs_fmodel_set_width(adcgs_fmodel *f, int group, int width);
/** Columns of the time table: f_t, followed by the bodies' poses. */
static inline int adcgs_fmodel_time_columns(const adcgs_params *params)
{
    return params->time_width + (int)adcgs_pose_columns(params);
}
/** The rows of the time table that are interpolated for a time, with weights. */
typedef struct adcgs_time_rows {
    int first, n;
    float weight[4]; /**< [n] */
} adcgs_time_rows;

/** Rows for t in [0,1] (splat/time_curve.h). */
adcgs_time_rows adcgs_fmodel_time_rows(const adcgs_params *params, float t);

#endif
