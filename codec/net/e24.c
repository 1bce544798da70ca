/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Loading an E24 network: the checks that make its arithmetic exact, and the
 * packing of its weights. With A * sum|w| + |b| + 2^(s-1) <= 2^24 - 1 in every
 * row, every partial sum in every order is an integer that neither int32 nor
 * binary32 has to round.
 */
#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include "base/cpu_detect.h"
#include "net/e24.h"

#include <inttypes.h>

#define SHIFT_MAX 24

static adcgs_e24_fn kernel_of(adcgs_cpu_level cpu)
{
#ifdef HAVE_AVX512
    if (cpu == ADCGS_CPU_AVX512)
        return adcgs_e24_eval_avx512;
#endif
#ifdef HAVE_AVX2
    if (cpu >= ADCGS_CPU_AVX2)
        return adcgs_e24_eval_avx2;
#endif
#ifdef ADCGS_WASM
    return adcgs_e24_eval_wasm;
#else
    return adcgs_e24_eval_scalar;
#endif
}

static adcgs_status check_shapes(const adcgs_net *net, adcgs_error *error)
{
    const int role = net->role, n = net->n_layers;
    if (n < 1 || n > ADCGS_NET_LAYERS_MAX)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %d has %d layers; 1 to %d are allowed", role, n, ADCGS_NET_LAYERS_MAX);
    if (net->in_shift > 8 || net->sigma_shift > SHIFT_MAX || net->sigma_offset < -64 || net->sigma_offset > 127)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %d: input shift %d, sigma shift %d or sigma offset %d is out of range",
                          role, net->in_shift, net->sigma_shift, net->sigma_offset);
    for (int l = 0; l < n; l++) {
        const adcgs_layer *layer = &net->layer[l];
        const uint32_t in_max = l ? ADCGS_NET_WIDTH_MAX : ADCGS_NET_INPUTS_MAX;
        const int chained = l ? layer->w.cols == net->layer[l - 1].w.rows : layer->w.cols > 0 || n == 1;
        if (!chained || layer->w.rows < 1 || layer->w.rows > ADCGS_NET_WIDTH_MAX || layer->w.cols > in_max ||
            layer->b.rows != layer->w.rows || layer->b.cols != 1)
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %d, layer %d: %u x %u weights and %u biases do not fit", role, l,
                              layer->w.rows, layer->w.cols, layer->b.rows);
        if (layer->w.mode != 0 || layer->b.mode != 0 || layer->shift > SHIFT_MAX)
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %d, layer %d: integer layers need mode 0 and a shift of 0 to %d",
                              role, l, SHIFT_MAX);
        if (layer->residual > 1 || (layer->residual && (l + 1 == n || layer->w.rows != layer->w.cols)))
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %d, layer %d cannot be residual", role, l);
    }
    if (adcgs_role_is_prior(role) && adcgs_net_outputs(net) % 2)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %d has %u outputs; a mean and a scale per channel make an even number",
                          role, adcgs_net_outputs(net));
    return ADCGS_OK;
}

/* Copy a row, and check the bound that makes it exact. */
static adcgs_status pack_row(int16_t *to, const adcgs_net *net, int l, uint32_t row, adcgs_error *error)
{
    const adcgs_layer *layer = &net->layer[l];
    const uint32_t n_in = layer->w.cols;
    const int is_sigma = l + 1 == net->n_layers && row >= adcgs_net_channels(net);
    const int shift = is_sigma ? net->sigma_shift : layer->shift;
    const int64_t bias = layer->b.m[row];
    int64_t sum = (bias < 0 ? -bias : bias) + (shift ? INT64_C(1) << (shift - 1) : 0);
    for (uint32_t i = 0; i < n_in; i++) {
        const int32_t w = layer->w.m[(size_t)row * n_in + i];
        if (w > ADCGS_E24_A || w < -ADCGS_E24_A)
            return adcgs_fail(error, ADCGS_ERR_DATA, "network %d, layer %d, row %u: weight %" PRId32 " exceeds %d", net->role, l,
                              row, w, ADCGS_E24_A);
        to[i] = (int16_t)w;
        sum += (int64_t)ADCGS_E24_A * (w < 0 ? -w : w);
    }
    if (sum > (1 << 24) - 1)
        return adcgs_fail(error, ADCGS_ERR_DATA, "network %d, layer %d, row %u: sums may reach %" PRId64 "; exact up to 2^24 - 1",
                          net->role, l, row, sum);
    return ADCGS_OK;
}

static adcgs_status pack_layer(adcgs_e24_layer *to, const adcgs_net *net, int l, adcgs_memory *memory, adcgs_error *error)
{
    const adcgs_layer *layer = &net->layer[l];
    const size_t rows = layer->w.rows, stride = (layer->w.cols + (size_t)1) & ~(size_t)1;
    to->n_in = (int)layer->w.cols;
    to->n_out = (int)rows;
    to->shift = layer->shift;
    to->residual = layer->residual;
    to->w = adcgs_alloc(memory, rows * stride, sizeof *to->w, error);
    to->b = adcgs_alloc(memory, rows, sizeof *to->b, error);
    if (!to->w || !to->b)
        return adcgs_alloc_status(error);
    for (uint32_t row = 0; row < rows; row++) {
        ADCGS_TRY(pack_row(to->w + row * stride, net, l, row, error));
        to->b[row] = layer->b.m[row];
    }
    return ADCGS_OK;
}

adcgs_status adcgs_e24_create(adcgs_e24 **out, const adcgs_net *net, adcgs_cpu_level cpu, adcgs_memory *memory,
                              adcgs_error *error)
{
    *out = NULL;
    ADCGS_TRY(adcgs_cpu_resolve(cpu, &cpu, error));
    ADCGS_TRY(check_shapes(net, error));
    adcgs_e24 *e24 = adcgs_alloc(memory, 1, sizeof *e24, error);
    if (!e24)
        return adcgs_alloc_status(error);
    uint32_t widest = 0;
    adcgs_status status = ADCGS_OK;
    for (int l = 0; l < net->n_layers && status == ADCGS_OK; l++) {
        widest = ADCGS_MAX(widest, ADCGS_MAX(net->layer[l].w.cols, net->layer[l].w.rows));
        status = pack_layer(&e24->layer[l], net, l, memory, error);
    }
    e24->n_layers = net->n_layers;
    e24->channels = (int)adcgs_net_channels(net);
    e24->in_shift = net->in_shift;
    e24->sigma_shift = net->sigma_shift;
    e24->sigma_offset = net->sigma_offset;
    e24->side = (size_t)(widest + 1) / 2 * ADCGS_LANES;
    e24->eval = kernel_of(cpu);
    if (status != ADCGS_OK)
        adcgs_e24_free(&e24, memory);
    *out = e24;
    return status;
}

void adcgs_e24_free(adcgs_e24 **out, adcgs_memory *memory)
{
    adcgs_e24 *net = *out;
    *out = NULL;
    if (!net)
        return;
    for (int l = 0; l < ADCGS_NET_LAYERS_MAX; l++) {
        adcgs_free(memory, net->layer[l].w);
        adcgs_free(memory, net->layer[l].b);
    }
    adcgs_free(memory, net);
}

size_t adcgs_e24_scratch(const adcgs_e24 *net)
{
    return 2 * net->side * sizeof(uint32_t);
}

void adcgs_e24_eval(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, void *scratch)
{
    net->eval(net, x, mu, si, scratch);
}
