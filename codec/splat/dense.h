/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Dense layers in strict binary32 over 64 samples (decision D3; spec clause
 * "Binary32 networks"). Every output is one chain of fused multiply-adds in
 * ascending input order, so every CPU gives the same bits. The trainer uses
 * the same kernel for its forward pass and its input gradients.
 */
#ifndef ADCGS_SPLAT_DENSE_H
#define ADCGS_SPLAT_DENSE_H

#include "net/net.h"

typedef struct adcgs_dense_dsp {
    /**
     * y[o][64] = start, then fma(w[o][i], x[i][64], y) for i = 0 .. n_in-1 ascending.
     * start is init[o][64] if init is given, else bias[o] if bias is given, else 0.
     * w: row o begins at w + o*ldw. y may be init; y must not overlap x. x, y, init are 64-byte aligned.
     */
    void (*dense)(float *y, const float *init, const float *bias, const float *w, size_t ldw, const float *x, int n_out,
                  int n_in);
    /** y[i] = y[i] < 0 ? y[i] * 2^-6 : y[i], n rows of 64. */
    void (*lrelu)(float *y, int n);
    /** y[i] = x[i] + lrelu(y[i]): the residual layer's tail, n rows of 64. */
    void (*residual)(float *y, const float *x, int n);
} adcgs_dense_dsp;

/** Fill a row of an input that is 1 in every lane; one is 64-byte aligned. */
static inline void adcgs_dense_ones(float one[ADCGS_LANES])
{
    for (int l = 0; l < ADCGS_LANES; l++)
        one[l] = 1;
}

/** level must be resolved. */
void adcgs_dense_dsp_init(adcgs_dense_dsp *dsp, adcgs_cpu_level level);

#endif
