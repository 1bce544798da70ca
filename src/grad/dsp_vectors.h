/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rows of 64 lanes as vectors of a CPU level: the operations that loops written by hand use, and the mask of negative lanes.
 */
#ifndef ADCGS_GRAD_DSP_VECTORS_H
#define ADCGS_GRAD_DSP_VECTORS_H

#include "model/model.h"

#define LANES ADCGS_LANES

#if defined(__AVX512F__)
#include <immintrin.h>
typedef __m512 vec;
#define VN 16 /* lanes of a vector; definition */
#define vzero _mm512_setzero_ps
#define vspread _mm512_set1_ps
#define vload _mm512_load_ps
#define vloadu _mm512_loadu_ps
#define vstoreu _mm512_storeu_ps
#define vfma _mm512_fmadd_ps
#define vadd _mm512_add_ps
#define vbelow(x) ((uint64_t)_mm512_cmp_ps_mask(x, _mm512_setzero_ps(), _CMP_LT_OQ))
#define vslope(x, below) _mm512_mask_mul_ps(x, (__mmask16)(below), x, _mm512_set1_ps(0x1p-6f))
#elif defined(__AVX2__)
#include <immintrin.h>
typedef __m256 vec;
#define VN 8 /* lanes of a vector; definition */
#define vzero _mm256_setzero_ps
#define vspread _mm256_set1_ps
#define vload _mm256_load_ps
#define vloadu _mm256_loadu_ps
#define vstoreu _mm256_storeu_ps
#define vfma _mm256_fmadd_ps
#define vadd _mm256_add_ps
#define vbelow(x) ((uint64_t)_mm256_movemask_ps(_mm256_cmp_ps(x, _mm256_setzero_ps(), _CMP_LT_OQ)))
static inline vec vslope(vec x, uint64_t below)
{
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32((int)(uint32_t)below), lane), lane);
    return _mm256_blendv_ps(x, _mm256_mul_ps(x, _mm256_set1_ps(0x1p-6f)), _mm256_castsi256_ps(set));
}
#else
typedef float vec;
#define VN 1 /* lanes of a vector; definition */
#define vzero() 0.0f
#define vspread(x) (x)
#define vload(p) (*(p))
#define vloadu(p) (*(p))
#define vstoreu(p, x) (*(p) = (x))
#define vfma(a, b, c) ((a) * (b) + (c))
#define vadd(a, b) ((a) + (b))
#define vbelow(x) ((uint64_t)((x) < 0))
/* clang-format off */
#define vslope(x, below) ((below) & 1 ? (x) * 0x1p-6f : (x))
/* clang-format on */
#endif

/** Mask of the negative lanes of a row. */
static inline uint64_t below_of(const float *row)
{
    uint64_t below = 0;
    for (int l = 0; l < LANES; l += VN)
        below |= vbelow(vload(row + l)) << l;
    return below;
}

#endif
