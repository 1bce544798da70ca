/* SPDX-License-Identifier: BSD-2-Clause */
/** \file E24 kernels for AVX2: three rows by 32 samples in registers. */
#include <immintrin.h>

#define E24_NAME(x) x##_avx2
#define E24_DENSE

#include "net/e24.h"

/* Rows j .. j+rows-1, 32 samples. rows is a constant where this is inlined, so the loops unroll. */
static inline __attribute__((always_inline)) void dense_tile(int32_t *acc, const int16_t *w, const int32_t *b, const uint32_t *x,
                                                             int pairs, int rows)
{
    __m256i sum[3][4];
    for (int j = 0; j < rows; j++)
        for (int q = 0; q < 4; q++)
            sum[j][q] = _mm256_set1_epi32(b[j]);
    for (int p = 0; p < pairs; p++, x += ADCGS_LANES) {
        for (int j = 0; j < rows; j++) {
            int32_t two;
            memcpy(&two, w + 2 * ((size_t)j * (size_t)pairs + (size_t)p), sizeof two);
            const __m256i weights = _mm256_set1_epi32(two);
            for (int q = 0; q < 4; q++)
                sum[j][q] = _mm256_add_epi32(sum[j][q], _mm256_madd_epi16(weights, _mm256_load_si256((const void *)(x + 8 * q))));
        }
    }
    for (int j = 0; j < rows; j++)
        for (int q = 0; q < 4; q++)
            _mm256_store_si256((void *)(acc + j * ADCGS_LANES + 8 * q), sum[j][q]);
}

static void e24_dense(int32_t *acc, const int16_t *w, const int32_t *b, const uint32_t *x, int n, int pairs)
{
    for (int j = 0; j < n; j += 3) {
        const int16_t *rows = w + 2 * (size_t)j * (size_t)pairs;
        for (int half = 0; half < 2; half++) {
            int32_t *to = acc + j * ADCGS_LANES + 32 * half;
            const uint32_t *from = x + 32 * half;
            if (n - j >= 3)
                dense_tile(to, rows, b + j, from, pairs, 3);
            else if (n - j == 2)
                dense_tile(to, rows, b + j, from, pairs, 2);
            else
                dense_tile(to, rows, b + j, from, pairs, 1);
        }
    }
}

#include "net/e24_kernels.h"
