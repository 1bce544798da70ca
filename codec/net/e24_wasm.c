/* SPDX-License-Identifier: BSD-2-Clause */
/** \file E24 kernels for WebAssembly's SIMD: three rows by 16 samples in registers. */
#include <wasm_simd128.h>

#define E24_NAME(x) x##_wasm
#define E24_DENSE

#include "net/e24.h"

/* Rows j .. j+rows-1, 16 samples. rows is a constant where this is inlined, so the loops unroll. */
static inline __attribute__((always_inline)) void dense_tile(int32_t *acc, const int16_t *w, const int32_t *b, const uint32_t *x,
                                                             int pairs, int rows)
{
    v128_t sum[3][4];
    for (int j = 0; j < rows; j++)
        for (int q = 0; q < 4; q++)
            sum[j][q] = wasm_i32x4_splat(b[j]);
    for (int p = 0; p < pairs; p++, x += ADCGS_LANES)
        for (int j = 0; j < rows; j++) {
            const v128_t weights = wasm_v128_load32_splat(w + 2 * ((size_t)j * (size_t)pairs + (size_t)p));
            for (int q = 0; q < 4; q++)
                sum[j][q] = wasm_i32x4_add(sum[j][q], wasm_i32x4_dot_i16x8(weights, wasm_v128_load(x + 4 * q)));
        }
    for (int j = 0; j < rows; j++)
        for (int q = 0; q < 4; q++)
            wasm_v128_store(acc + j * ADCGS_LANES + 4 * q, sum[j][q]);
}

static void e24_dense(int32_t *acc, const int16_t *w, const int32_t *b, const uint32_t *x, int n, int pairs)
{
    for (int j = 0; j < n; j += 3) {
        const int16_t *rows = w + 2 * (size_t)j * (size_t)pairs;
        for (int at = 0; at < ADCGS_LANES; at += 16) {
            int32_t *to = acc + j * ADCGS_LANES + at;
            if (n - j >= 3)
                dense_tile(to, rows, b + j, x + at, pairs, 3);
            else if (n - j == 2)
                dense_tile(to, rows, b + j, x + at, pairs, 2);
            else
                dense_tile(to, rows, b + j, x + at, pairs, 1);
        }
    }
}

#include "net/e24_kernels.h"
