/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Internals of the E24 evaluation: the packed network that its kernels share. */
#ifndef ADCGS_NET_E24_H
#define ADCGS_NET_E24_H

#include "net/net.h"

/** Bound of every activation (A in the specification) and of every weight. */
#define ADCGS_E24_A 2047

typedef struct adcgs_e24_layer {
    int n_in, n_out, shift, residual;
    int16_t *w; /**< [n_out][n_in rounded up to even] */
    int32_t *b; /**< [n_out] */
} adcgs_e24_layer;

typedef void (*adcgs_e24_fn)(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, uint32_t *scratch);

struct adcgs_e24 {
    int n_layers, channels, in_shift, sigma_shift, sigma_offset;
    size_t side; /**< elements of one activation buffer; there are two */
    adcgs_e24_fn eval;
    adcgs_e24_layer layer[ADCGS_NET_LAYERS_MAX];
};

void adcgs_e24_eval_scalar(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, uint32_t *scratch);
void adcgs_e24_eval_avx2(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, uint32_t *scratch);
void adcgs_e24_eval_avx512(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, uint32_t *scratch);
void adcgs_e24_eval_wasm(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, uint32_t *scratch);

#endif
