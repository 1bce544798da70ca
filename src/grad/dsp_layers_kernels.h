/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Layers of the trainer's networks backward, and residual layers forward, for one CPU level. The weight gradient is written by
 * hand.
 */
#ifndef ADCGS_GRAD_DSP_LAYERS_KERNELS_H
#define ADCGS_GRAD_DSP_LAYERS_KERNELS_H

#include "grad/dsp.h"
#include "grad/dsp_vectors.h"

#include <stdalign.h>

/* Outputs and vectors of inputs whose products stay in registers during the loop over lanes; arithmetic of the registers. */
enum { TILE_O = 6, TILE_V = VN == 16 ? 4 : 2, TILE_I = TILE_V * VN };

#if VN > 1
/** Transposes n of eight rows of eight lanes; the other rows count as 0. */
static inline __attribute__((always_inline)) void turn_eight(float *to, const float *from, int n)
{
    for (int half = 0; half < 2; half++, from += 4, to += 4 * TILE_I) {
        __m256 r[4];
#pragma GCC unroll 4
        for (int i = 0; i < 4; i++) {
            const __m128 low = i < n ? _mm_load_ps(from + i * LANES) : _mm_setzero_ps();
            const __m128 high = i + 4 < n ? _mm_load_ps(from + (i + 4) * LANES) : _mm_setzero_ps();
            r[i] = _mm256_insertf128_ps(_mm256_castps128_ps256(low), high, 1);
        }
        const __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
        const __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
        _mm256_store_ps(to, _mm256_shuffle_ps(a, c, 0x44));
        _mm256_store_ps(to + TILE_I, _mm256_shuffle_ps(a, c, 0xee));
        _mm256_store_ps(to + 2 * TILE_I, _mm256_shuffle_ps(b, d, 0x44));
        _mm256_store_ps(to + 3 * TILE_I, _mm256_shuffle_ps(b, d, 0xee));
    }
}

/** to[lane][input] of n inputs from x[input][lane]; the last vector's other inputs are 0. */
static void turn(float to[LANES][TILE_I], const float *x, int n)
{
    for (int i = 0; i < (n + VN - 1) / VN * VN; i += 8)
        for (int l = 0; l < LANES; l += 8)
            if (n - i >= 8)
                turn_eight(&to[l][i], x + (size_t)i * LANES + l, 8);
            else
                turn_eight(&to[l][i], x + (size_t)i * LANES + l, n - i);
}

/** Adds to gb[n], up to eight, the sums over lanes of dy[n][64]. */
static inline __attribute__((always_inline)) void sum_lanes(float *gb, const float *dy, int n)
{
    __m256 row[8] = {_mm256_setzero_ps()}, half[4];
    float sums[8];
    for (int l = 0; l < LANES; l += 8)
#pragma GCC unroll 8
        for (int i = 0; i < 8; i++)
            if (i < n)
                row[i] = _mm256_add_ps(row[i], _mm256_load_ps(dy + i * LANES + l));
#pragma GCC unroll 4
    for (int i = 0; i < 4; i++)
        half[i] =
            _mm256_add_ps(_mm256_permute2f128_ps(row[i], row[i + 4], 0x20), _mm256_permute2f128_ps(row[i], row[i + 4], 0x31));
    _mm256_storeu_ps(sums, _mm256_hadd_ps(_mm256_hadd_ps(half[0], half[1]), _mm256_hadd_ps(half[2], half[3])));
    for (int i = 0; i < n; i++)
        gb[i] += sums[i];
}

static void bias_grad(float *gb, const float *dy, int n)
{
    for (; n >= 8; n -= 8, gb += 8, dy += 8 * LANES)
        sum_lanes(gb, dy, 8);
    if (n)
        sum_lanes(gb, dy, n);
}
#else
static void turn(float to[LANES][TILE_I], const float *x, int n)
{
    for (int l = 0; l < LANES; l++)
        for (int i = 0; i < n; i++)
            to[l][i] = x[(size_t)i * LANES + (size_t)l];
}

static void bias_grad(float *gb, const float *dy, int n)
{
    for (int o = 0; o < n; o++) {
        float sum = 0;
        for (int l = 0; l < LANES; l++)
            sum += dy[o * LANES + l];
        gb[o] += sum;
    }
}
#endif

/** Gradients of `no` weight rows, ni of each in nv vectors, from lanes of their outputs dy[no][64] and inputs xt[64][TILE_I]. */
static inline __attribute__((always_inline)) void weight_tile(float *gw, size_t ldg, const float *dy, float xt[LANES][TILE_I],
                                                              int no, int nv, int ni)
{
    vec acc[TILE_O][TILE_V];
    for (int o = 0; o < no; o++)
        for (int v = 0; v < nv; v++)
            acc[o][v] = vzero();
    for (int l = 0; l < LANES; l++) {
        vec x[TILE_V];
        for (int v = 0; v < nv; v++)
            x[v] = vload(xt[l] + v * VN);
#pragma GCC unroll 6
        for (int o = 0; o < no; o++) {
            const vec d = vspread(dy[o * LANES + l]);
#pragma GCC unroll 4
            for (int v = 0; v < nv; v++)
                acc[o][v] = vfma(d, x[v], acc[o][v]);
        }
    }
#pragma GCC unroll 6
    for (int o = 0; o < no; o++, gw += ldg) {
        float rest[VN];
#pragma GCC unroll 4
        for (int v = 0; v < nv; v++)
            if ((v + 1) * VN <= ni)
                vstoreu(gw + v * VN, vadd(vloadu(gw + v * VN), acc[o][v]));
        vstoreu(rest, acc[o][nv - 1]);
        for (int i = ni / VN * VN; i < ni; i++)
            gw[i] += rest[i % VN];
    }
}

static inline __attribute__((always_inline)) void weight_rows(float *gw, size_t ldg, const float *dy, float xt[LANES][TILE_I],
                                                              int no, int nv, int ni)
{
    switch (no) {
    case 6:
        weight_tile(gw, ldg, dy, xt, 6, nv, ni);
        break;
    case 5:
        weight_tile(gw, ldg, dy, xt, 5, nv, ni);
        break;
    case 4:
        weight_tile(gw, ldg, dy, xt, 4, nv, ni);
        break;
    case 3:
        weight_tile(gw, ldg, dy, xt, 3, nv, ni);
        break;
    case 2:
        weight_tile(gw, ldg, dy, xt, 2, nv, ni);
        break;
    default:
        weight_tile(gw, ldg, dy, xt, 1, nv, ni);
        break;
    }
}

/** Divides n_out rows evenly: a rest of one or two would leave the multipliers idle. */
static void weight_columns(float *gw, size_t ldg, const float *dy, float xt[LANES][TILE_I], int n_out, int ni)
{
    const int groups = (n_out + TILE_O - 1) / TILE_O;
    for (int g = 0, o = 0, no; g < groups; g++, o += no, gw += (size_t)no * ldg, dy += no * LANES) {
        no = (n_out - o + groups - g - 1) / (groups - g);
        switch ((ni + VN - 1) / VN) {
#if VN == 16
        case 4:
            weight_rows(gw, ldg, dy, xt, no, 4, ni);
            break;
        case 3:
            weight_rows(gw, ldg, dy, xt, no, 3, ni);
            break;
#endif
        case 2:
            weight_rows(gw, ldg, dy, xt, no, 2, ni);
            break;
        default:
            weight_rows(gw, ldg, dy, xt, no, 1, ni);
            break;
        }
    }
}

static void ISA(weight_grad)(float *gw, size_t ldg, float *gb, const float *dy, size_t sy, const float *x, size_t sx, int tiles,
                             int n_out, int n_in)
{
    const int vectors = (n_in + VN - 1) / VN, blocks = (vectors + TILE_V - 1) / TILE_V;
    alignas(64) float xt[LANES][TILE_I];
    for (int t = 0; t < tiles; t++, dy += sy, x += sx) {
        for (int b = 0, i = 0, ni; b < blocks; b++, i += ni) {
            ni = ADCGS_MIN((vectors - i / VN + blocks - b - 1) / (blocks - b) * VN, n_in - i);
            turn(xt, x + (size_t)i * LANES, ni);
            weight_columns(gw + i, ldg, dy, xt, n_out, ni);
        }
        if (gb)
            bias_grad(gb, dy, n_out);
    }
}

static void ISA(lrelu_back)(float *restrict dz, const float *restrict h, int n)
{
    for (int i = 0; i < n * LANES; i++)
        dz[i] *= h[i] < 0 ? 0x1p-6f : 1.0f;
}

/* A few rows at a time, so that their sums stay in the L1 cache. */
static void ISA(residual)(const adcgs_train_dsp *dsp, float *h, uint64_t *below, const float *bias, const adcgs_square *w,
                          const float *x)
{
    enum { ROWS = 36 };
    const int n = w->n;
    alignas(64) float z[ROWS * LANES];
    for (int o = 0; o < n; o += ROWS) {
        const int rows = n - o < ROWS ? n - o : ROWS;
        dsp->dense.dense(z, NULL, bias + o, w->w + (size_t)o * (size_t)n, (size_t)n, x, rows, n);
        dsp->hidden(h + (size_t)o * LANES, below + o, z, x + (size_t)o * LANES, rows);
    }
}

static void ISA(residual_back)(const adcgs_train_dsp *dsp, float *dx, float *dz, const uint64_t *below, const adcgs_square *turn,
                               const float *dh, const float *io)
{
    const int n = turn->n;
    for (int i = 0; i < n; i++)
        for (int l = 0; l < LANES; l += VN)
            vstoreu(dz + i * LANES + l, vslope(vload(dh + i * LANES + l), below[i] >> l));
    dsp->dense.dense(dx, dh, NULL, turn->w, (size_t)n, dz, n, n);
}

#endif
