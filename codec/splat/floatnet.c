/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Binary32 networks: conversion of the stream's tensors and evaluation after layer 0. */
#include "splat/floatnet.h"

float adcgs_tensor_value(const adcgs_tensor *t, size_t index)
{
    if (t->mode)
        return adcgs_bits_float((uint32_t)t->m[index]);
    /* Exact: |m| < 2^24, and 2^-e is a normal number. */
    return (float)t->m[index] * adcgs_bits_float((uint32_t)(127 - t->e) << 23);
}

static float *convert(float *to, const adcgs_tensor *t)
{
    const size_t n = (size_t)t->rows * t->cols;
    for (size_t i = 0; i < n; i++)
        to[i] = adcgs_tensor_value(t, i);
    return to + n;
}

adcgs_status adcgs_floatnet_init(adcgs_floatnet *out, const adcgs_net *net, adcgs_memory *memory, adcgs_error *error)
{
    *out = (adcgs_floatnet){0};
    if (!net->present)
        return ADCGS_OK;
    out->data = adcgs_alloc(memory, adcgs_net_weights(net), sizeof(float), error);
    if (!out->data)
        return adcgs_alloc_status(error);
    out->n_layers = net->n_layers;
    float *to = out->data;
    for (int i = 0; i < net->n_layers; i++) {
        const adcgs_layer *from = &net->layer[i];
        adcgs_float_layer *layer = &out->layer[i];
        *layer = (adcgs_float_layer){.n_out = (int)from->w.rows, .n_in = (int)from->w.cols, .residual = from->residual};
        layer->w = to;
        to = convert(to, &from->w);
        layer->b = to;
        to = convert(to, &from->b);
        out->width = ADCGS_MAX(out->width, layer->n_out);
    }
    return ADCGS_OK;
}

void adcgs_floatnet_clear(adcgs_floatnet *net, adcgs_memory *memory)
{
    adcgs_free(memory, net->data);
    *net = (adcgs_floatnet){0};
}

float *adcgs_floatnet_finish(const adcgs_floatnet *net, const adcgs_dense_dsp *dsp, float *z, float *other)
{
    for (int i = 1; i < net->n_layers; i++) {
        const adcgs_float_layer *layer = &net->layer[i];
        if (i == 1)
            dsp->lrelu(z, layer->n_in);
        dsp->dense(other, NULL, layer->b, layer->w, (size_t)layer->n_in, z, layer->n_out, layer->n_in);
        if (layer->residual)
            dsp->residual(other, z, layer->n_out);
        else if (i + 1 < net->n_layers)
            dsp->lrelu(other, layer->n_out);
        float *const swap = z;
        z = other;
        other = swap;
    }
    return z;
}
