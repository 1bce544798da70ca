/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Dense layers, 8 lanes per vector. */
#include "splat/dense_isa.h"

#include <immintrin.h>

#define V __m256
#define VW 8
#define COLS 2
#define LOAD _mm256_load_ps
#define STORE _mm256_store_ps
#define SPREAD _mm256_set1_ps
#define FMADD _mm256_fmadd_ps
#define ADDV _mm256_add_ps
#define LRELU lrelu_vector

static inline __m256 lrelu_vector(__m256 v)
{
    const __m256 negative = _mm256_cmp_ps(v, _mm256_setzero_ps(), _CMP_LT_OQ);
    return _mm256_blendv_ps(v, _mm256_mul_ps(v, _mm256_set1_ps(0x1p-6f)), negative);
}

#include "splat/dense_kernels.h"

const adcgs_dense_dsp adcgs_dense_avx2 = {dense, lrelu, residual};
