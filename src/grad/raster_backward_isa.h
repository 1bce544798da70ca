/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Interface of the kernels of the backward pass, and their variants; only for raster_backward.c. */
#ifndef ADCGS_GRAD_RASTER_BACKWARD_ISA_H
#define ADCGS_GRAD_RASTER_BACKWARD_ISA_H

#include "grad/raster.h"

/*
 * Sums over the pixels of a (splat, tile) pair, in the order of the twelve results of vf_sums(). e is alpha * dL/dalpha.
 * Definition.
 */
enum {
    SUM_E = 0,   /* e */
    SUM_EX = 4,  /* e dx */
    SUM_EY = 8,  /* e dy */
    SUM_EXX = 1, /* e dx dx */
    SUM_EXY = 5, /* e dx dy */
    SUM_EYY = 9, /* e dy dy */
    SUM_RED = 2, /* alpha T dL/dC, per colour */
    SUM_GREEN = 6,
    SUM_BLUE = 10,
    SUM_WEIGHT = 12, /* alpha T */
    SUM_ABS_U = 13,  /* |e (2a dx + b dy)| */
    SUM_ABS_V = 14,  /* |e (b dx + 2c dy)| */
    SUM_WORDS = 16
};

typedef struct adcgs_back_job {
    adcgs_kept kept;
    const adcgs_primitives *primitives;
    const adcgs_view *view;
    float filter;
    const float *rgb, *grad; /* [3][height][width] */
    float *sums;             /* [entries][SUM_WORDS], pairs splat by splat */
    adcgs_raster_grads out;
} adcgs_back_job;

typedef struct adcgs_back_dsp {
    /** Computes the sums of a tile's entries. */
    void (*blend)(const adcgs_back_job *job, int tile);
    /** Adds the sums of 64 slots' splats, and computes the gradients of the slots. */
    void (*project)(const adcgs_back_job *job, uint32_t first);
} adcgs_back_dsp;

extern const adcgs_back_dsp adcgs_back_scalar, adcgs_back_avx2, adcgs_back_avx512;

#endif
