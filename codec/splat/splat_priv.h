/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The state of prediction and deformation, shared by the files that create it and that move it to a time. */
#ifndef ADCGS_SPLAT_SPLAT_PRIV_H
#define ADCGS_SPLAT_SPLAT_PRIV_H

#include "splat/floatnet.h"
#include "splat/rigid_motion.h"
#include "splat/rows.h"
#include "splat/splat.h"
#include "splat/splat_isa.h"
#include "splat/steps.h"

struct adcgs_splat {
    const adcgs_model *model;
    adcgs_pool *pool;
    adcgs_memory *memory;
    adcgs_dense_dsp dense;
    adcgs_splat_dsp dsp;
    adcgs_floatnet prediction, coarse, fine;
    adcgs_steps steps;
    uint32_t groups, moving;        /* groups of 64 anchors; groups in which an anchor moves */
    int width;                      /* widest layer of the networks */
    float *out;                     /* [ADCGS_ROWS][groups*k*64] */
    uint32_t *moving_group;         /* [moving] */
    adcgs_anchor_lanes *anchors;    /* [moving] */
    adcgs_slot_lanes *slots;        /* [moving][k] */
    int32_t *present;               /* [moving][k][64] */
    int32_t *moves;                 /* [moving][64] */
    float *coarse_part, *fine_part; /* [moving][outputs of layer 0][64]: layer 0 over the static inputs */
    float *scratch;                 /* [threads][scratch_rows][64] */
    size_t scratch_rows;
    float *time_code, *coarse_time, *fine_time; /* interpolated row of Z; bias and f_t's part of layer 0 */
    adcgs_body_pose pose[ADCGS_BODIES_MAX];
    float time;
    int has_time;
};

/* The place of primitive k of a group in the output. */
static inline adcgs_slot_out adcgs_slot_out_of(const adcgs_splat *s, uint32_t group, int k)
{
    const size_t per_anchor = s->model->params.k;
    return adcgs_rows_at(s->out, s->groups * per_anchor * ADCGS_LANES, adcgs_slot_of(group * ADCGS_LANES, s->model->params.k, k));
}

/* Number of columns of Z: f_t, and the poses. */
static inline size_t adcgs_time_columns(const adcgs_model *m)
{
    return (size_t)m->params.time_width + adcgs_pose_columns(&m->params);
}

#endif
