/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The E24 kernels, compiled once per CPU level by e24_scalar.c, e24_avx2.c and
 * e24_avx512.c. The including file defines E24_NAME(x) and may define
 * E24_DENSE if it has its own e24_dense(). Activations are stored in pairs of
 * features, as the multiply-add instructions need them: element (feature f,
 * sample s) is the low (f even) or high (f odd) half of x[(f / 2) * 64 + s].
 * Everything is an integer below 2^24 (checked when the network is loaded), so
 * all variants agree exactly.
 */
#include "net/e24.h"

#ifndef E24_DENSE
/* acc[j][s] = b[j] + sum over features of w[j][f] x[f][s] for rows [0, n) */
static void e24_dense(int32_t *restrict acc, const int16_t *w, const int32_t *b, const uint32_t *x, int n, int pairs)
{
    int16_t even[ADCGS_LANES], odd[ADCGS_LANES];
    for (int j = 0; j < n; j++)
        for (int s = 0; s < ADCGS_LANES; s++)
            acc[j * ADCGS_LANES + s] = b[j];
    for (int p = 0; p < pairs; p++, x += ADCGS_LANES) {
        for (int s = 0; s < ADCGS_LANES; s++) {
            even[s] = (int16_t)(x[s] & 0xffff);
            odd[s] = (int16_t)(x[s] >> 16);
        }
        for (int j = 0; j < n; j++) {
            const int16_t *pair = w + 2 * ((size_t)j * (size_t)pairs + (size_t)p);
            const int16_t w0 = pair[0], w1 = pair[1];
            for (int s = 0; s < ADCGS_LANES; s++)
                acc[j * ADCGS_LANES + s] += even[s] * w0 + odd[s] * w1;
        }
    }
}
#endif

_Static_assert(-3 >> 1 == -2, "shifts of negative numbers go down");

/* shr() for |v| + 2^(s-1) < 2^31. */
static inline int32_t e24_shr(int32_t v, int s)
{
    return (v + (1 << s >> 1)) >> s;
}

/* The larger of v and shr(v, 6): for negative v, shr(v, 6) is nearer to zero. */
static inline int32_t e24_lrelu(int32_t v)
{
    const int32_t slow = e24_shr(v, 6);
    return v > slow ? v : slow;
}

static inline uint32_t e24_pair(int32_t even, int32_t odd)
{
    return ((uint32_t)even & 0xffff) | (uint32_t)odd << 16;
}

/*
 * shr(x, s) limited to the bound of activations, with factor = 2^(15-s): many machines round a product of 16-bit numbers like
 * this. For s = 0 the factor is 2^15 - 1, which only changes results far beyond the bound.
 */
static inline int16_t e24_scaled(int16_t x, int16_t factor)
{
    const int16_t v = (int16_t)(((x * factor >> 14) + 1) >> 1);
    return v < -ADCGS_E24_A ? -ADCGS_E24_A : v > ADCGS_E24_A ? ADCGS_E24_A : v;
}

static void e24_input(uint32_t *out, const int16_t *x, int n, int shift)
{
    static const int16_t nothing[ADCGS_LANES];
    const int16_t factor = (int16_t)ADCGS_MIN(1 << (15 - shift), INT16_MAX);
    for (int f = 0; f < n; f += 2, out += ADCGS_LANES) {
        const int16_t *even = x + f * ADCGS_LANES, *odd = f + 1 < n ? even + ADCGS_LANES : nothing;
        int16_t a[ADCGS_LANES], b[ADCGS_LANES];
        for (int s = 0; s < ADCGS_LANES; s++) {
            a[s] = e24_scaled(even[s], factor);
            b[s] = e24_scaled(odd[s], factor);
        }
        for (int s = 0; s < ADCGS_LANES; s++)
            out[s] = e24_pair(a[s], b[s]);
    }
}

/* Activation of n rows of a hidden layer. in: these rows in the layer's input, for residual layers; else NULL. */
static void e24_hidden(uint32_t *out, int32_t *acc, const uint32_t *in, int n, int shift)
{
    if (n & 1)
        memset(acc + n * ADCGS_LANES, 0, ADCGS_LANES * sizeof *acc);
    for (int j = 0; j < n; j += 2, acc += 2 * ADCGS_LANES, out += ADCGS_LANES) {
        const int32_t *even = acc, *odd = acc + ADCGS_LANES;
        if (in) {
            for (int s = 0; s < ADCGS_LANES; s++)
                out[s] = e24_pair(adcgs_clip((int16_t)(in[s] & 0xffff) + e24_lrelu(e24_shr(even[s], shift)), ADCGS_E24_A),
                                  adcgs_clip((int16_t)(in[s] >> 16) + e24_lrelu(e24_shr(odd[s], shift)), ADCGS_E24_A));
            in += ADCGS_LANES;
        } else {
            for (int s = 0; s < ADCGS_LANES; s++)
                out[s] = e24_pair(adcgs_clip(e24_lrelu(e24_shr(even[s], shift)), ADCGS_E24_A),
                                  adcgs_clip(e24_lrelu(e24_shr(odd[s], shift)), ADCGS_E24_A));
        }
    }
}

static void e24_output(const adcgs_e24 *net, const int32_t *acc, int first, int n, int16_t *mu, uint8_t *si)
{
    /* Read these once: the compiler must assume that storing a byte may change them. */
    const int channels = net->channels, offset = net->sigma_offset;
    const int mu_shift = net->layer[net->n_layers - 1].shift, si_shift = net->sigma_shift;
    for (int row = first; row < first + n; row++, acc += ADCGS_LANES) {
        if (row < channels) {
            for (int s = 0; s < ADCGS_LANES; s++)
                mu[row * ADCGS_LANES + s] = (int16_t)adcgs_clip(e24_shr(acc[s], mu_shift), 32767);
            continue;
        }
        for (int s = 0; s < ADCGS_LANES; s++) {
            const int32_t v = e24_shr(acc[s], si_shift) + offset;
            si[(row - channels) * ADCGS_LANES + s] = (uint8_t)(v < 0                        ? 0
                                                               : v > ADCGS_SIGMA_LEVELS - 1 ? ADCGS_SIGMA_LEVELS - 1
                                                                                            : v);
        }
    }
}

void E24_NAME(adcgs_e24_eval)(const adcgs_e24 *net, const int16_t *x, int16_t *mu, uint8_t *si, uint32_t *scratch)
{
    enum { BLOCK = 12 }; /* even, so that a pair of features never straddles two blocks */
    _Alignas(64) int32_t acc[BLOCK * ADCGS_LANES];
    uint32_t *in = scratch, *out = scratch + net->side;
    e24_input(in, x, net->layer[0].n_in, net->in_shift);
    for (int l = 0; l < net->n_layers; l++) {
        const adcgs_e24_layer *layer = &net->layer[l];
        const int pairs = (layer->n_in + 1) / 2;
        for (int first = 0; first < layer->n_out; first += BLOCK) {
            const int n = ADCGS_MIN(BLOCK, layer->n_out - first);
            const size_t at = (size_t)first / 2 * ADCGS_LANES;
            e24_dense(acc, layer->w + (size_t)first * 2 * (size_t)pairs, layer->b + first, in, n, pairs);
            if (l + 1 < net->n_layers)
                e24_hidden(out + at, acc, layer->residual ? in + at : NULL, n, layer->shift);
            else
                e24_output(net, acc, first, n, mu, si);
        }
        uint32_t *swap = in;
        in = out;
        out = swap;
    }
}
