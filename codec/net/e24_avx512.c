/* SPDX-License-Identifier: BSD-2-Clause */
/** \file E24 kernels for AVX-512 BW: up to six rows by 64 samples in registers. */
#include <immintrin.h>

#define E24_NAME(x) x##_avx512
#define E24_DENSE

#include "net/e24.h"

/* The rows from w and b on, all samples. rows is a constant where this is inlined, so the loops unroll. */
static inline __attribute__((always_inline)) void dense_tile(int32_t *acc, const int16_t *w, const int32_t *b, const uint32_t *x,
                                                             int pairs, int rows)
{
    __m512i sum[6][4];
    for (int j = 0; j < rows; j++)
        for (int q = 0; q < 4; q++)
            sum[j][q] = _mm512_set1_epi32(b[j]);
    for (int p = 0; p < pairs; p++, x += ADCGS_LANES) {
        __m512i in[4];
        for (int q = 0; q < 4; q++)
            in[q] = _mm512_load_si512((const void *)(x + 16 * q));
        for (int j = 0; j < rows; j++) {
            int32_t two;
            memcpy(&two, w + 2 * ((size_t)j * (size_t)pairs + (size_t)p), sizeof two);
            const __m512i weights = _mm512_set1_epi32(two);
            for (int q = 0; q < 4; q++)
                sum[j][q] = _mm512_add_epi32(sum[j][q], _mm512_madd_epi16(weights, in[q]));
        }
    }
    for (int j = 0; j < rows; j++)
        for (int q = 0; q < 4; q++)
            _mm512_store_si512((void *)(acc + j * ADCGS_LANES + 16 * q), sum[j][q]);
}

/* Distribute the rows evenly over tiles: a tile of few rows would load more than it multiplies. */
static void e24_dense(int32_t *acc, const int16_t *w, const int32_t *b, const uint32_t *x, int n, int pairs)
{
    for (int j = 0, tiles = (n + 5) / 6, rows; tiles > 0; tiles--, j += rows) {
        const int16_t *weights = w + 2 * (size_t)j * (size_t)pairs;
        int32_t *to = acc + j * ADCGS_LANES;
        rows = (n - j + tiles - 1) / tiles;
        switch (rows) {
        case 6:
            dense_tile(to, weights, b + j, x, pairs, 6);
            break;
        case 5:
            dense_tile(to, weights, b + j, x, pairs, 5);
            break;
        case 4:
            dense_tile(to, weights, b + j, x, pairs, 4);
            break;
        case 3:
            dense_tile(to, weights, b + j, x, pairs, 3);
            break;
        case 2:
            dense_tile(to, weights, b + j, x, pairs, 2);
            break;
        default:
            dense_tile(to, weights, b + j, x, pairs, 1);
            break;
        }
    }
}

#include "net/e24_kernels.h"
