/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Dense layers, 16 lanes per vector. */
#include "splat/dense_isa.h"

#include <immintrin.h>

#define V __m512
#define VW 16
#define COLS 4
#define LOAD _mm512_load_ps
#define STORE _mm512_store_ps
#define SPREAD _mm512_set1_ps
#define FMADD _mm512_fmadd_ps
#define ADDV _mm512_add_ps
#define LRELU lrelu_vector

static inline __m512 lrelu_vector(__m512 v)
{
    const __mmask16 negative = _mm512_cmp_ps_mask(v, _mm512_setzero_ps(), _CMP_LT_OQ);
    return _mm512_mask_mul_ps(v, negative, v, _mm512_set1_ps(0x1p-6f));
}

#include "splat/dense_kernels.h"

const adcgs_dense_dsp adcgs_dense_avx512 = {dense, lrelu, residual};
