/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * A binary32 network prepared for evaluation (spec clause "Binary32 networks").
 * The caller evaluates layer 0, since its inputs come in parts that are valid
 * for different times. One call evaluates all later layers.
 */
#ifndef ADCGS_SPLAT_FLOATNET_H
#define ADCGS_SPLAT_FLOATNET_H

#include "splat/dense.h"

typedef struct adcgs_float_layer {
    const float *w, *b; /**< [n_out][n_in], [n_out] */
    int n_out, n_in, residual;
} adcgs_float_layer;

typedef struct adcgs_floatnet {
    int n_layers; /**< 0: absent */
    int width;    /**< widest layer, at least the outputs */
    adcgs_float_layer layer[ADCGS_NET_LAYERS_MAX];
    float *data;
} adcgs_floatnet;

/** Convert a network; an absent network gives n_layers 0. */
adcgs_status adcgs_floatnet_init(adcgs_floatnet *out, const adcgs_net *net, adcgs_memory *memory, adcgs_error *error);
void adcgs_floatnet_clear(adcgs_floatnet *net, adcgs_memory *memory);
/**
 * Evaluate from layer 0's sums to the outputs [n_out][64]. z: [width][64], layer 0's sums, overwritten; other: [width][64]
 * scratch. Returns the buffer with the outputs: z or other.
 */
float *adcgs_floatnet_finish(const adcgs_floatnet *net, const adcgs_dense_dsp *dsp, float *z, float *other);
/** Value of an element of a tensor. */
float adcgs_tensor_value(const adcgs_tensor *t, size_t index);

#endif
