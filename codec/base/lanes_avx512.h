/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sixteen lanes in one AVX-512 register; see lanes.h. */
#include <immintrin.h>

typedef __m512 vf;
typedef __mmask16 vm;

LANES_INLINE vf vf_set1(float x) { return _mm512_set1_ps(x); }
LANES_INLINE vf vf_load(const float *p) { return _mm512_load_ps(p); }
LANES_INLINE vf vf_loadu(const float *p) { return _mm512_loadu_ps(p); }
LANES_INLINE void vf_storeu(float *p, vf a) { _mm512_storeu_ps(p, a); }
LANES_INLINE void vf_store(float *p, vf a) { _mm512_store_ps(p, a); }
LANES_INLINE vf vf_add(vf a, vf b) { return _mm512_add_ps(a, b); }
LANES_INLINE vf vf_sub(vf a, vf b) { return _mm512_sub_ps(a, b); }
LANES_INLINE vf vf_mul(vf a, vf b) { return _mm512_mul_ps(a, b); }
LANES_INLINE vf vf_div(vf a, vf b) { return _mm512_div_ps(a, b); }
LANES_INLINE vf vf_sqrt(vf a) { return _mm512_sqrt_ps(a); }
LANES_INLINE vf vf_fma(vf a, vf b, vf c) { return _mm512_fmadd_ps(a, b, c); }
LANES_INLINE vf vf_fnma(vf a, vf b, vf c) { return _mm512_fnmadd_ps(a, b, c); }
LANES_INLINE vf vf_min(vf a, vf b) { return _mm512_min_ps(a, b); }
LANES_INLINE vf vf_max(vf a, vf b) { return _mm512_max_ps(a, b); }
LANES_INLINE vf vf_abs(vf a) { return _mm512_abs_ps(a); }
LANES_INLINE vm vf_ge(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_GE_OQ); }
LANES_INLINE int vm_any(vm m) { return m != 0; }
/* m ? a : 0 */
LANES_INLINE vf vf_only(vm m, vf a) { return _mm512_maskz_mov_ps(m, a); }
/* c with a*b added where m */
LANES_INLINE vf vf_fma_where(vm m, vf a, vf b, vf c) { return _mm512_mask3_fmadd_ps(a, b, c, m); }
LANES_INLINE vf vf_fnma_where(vm m, vf a, vf b, vf c) { return _mm512_mask3_fnmadd_ps(a, b, c, m); }

LANES_INLINE vf vf_scale2(vf p, vf rounded)
{
    return _mm512_castsi512_ps(_mm512_add_epi32(_mm512_castps_si512(p), _mm512_slli_epi32(_mm512_castps_si512(rounded), 23)));
}

/* Truncate 0 <= a < 2^31 to integers. */
LANES_INLINE void vf_store_int(int32_t *p, vf a)
{
    _mm512_store_si512(p, _mm512_cvttps_epi32(a));
}

/* Store row i, four lanes, to row[i]. */
LANES_INLINE void vf_store_rows(float *const row[4], vf a)
{
    _mm_storeu_ps(row[0], _mm512_castps512_ps128(a));
    _mm_storeu_ps(row[1], _mm512_extractf32x4_ps(a, 1));
    _mm_storeu_ps(row[2], _mm512_extractf32x4_ps(a, 2));
    _mm_storeu_ps(row[3], _mm512_extractf32x4_ps(a, 3));
}

/* Load four rows of four lanes each, stride floats apart. */
LANES_INLINE vf vf_load_rows(const float *p, size_t stride)
{
    const __m256 a = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p + stride), 1);
    const __m256 b = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 2 * stride)), _mm_loadu_ps(p + 3 * stride), 1);
    return _mm512_insertf32x8(_mm512_castps256_ps512(a), b, 1);
}

/* Load once and keep in a register. GCC would load again at each use, and only one load fits in the time of a multiply-add. */
LANES_INLINE vf vf_load_once(const float *p)
{
    vf a = _mm512_load_ps(p);
    __asm__("" : "+v"(a));
    return a;
}

/* Each lane takes the value of the next lane, or of the lane before; 0 beyond the ends. */
LANES_INLINE vf vf_next(vf a)
{
    return _mm512_castsi512_ps(_mm512_alignr_epi32(_mm512_setzero_si512(), _mm512_castps_si512(a), 1));
}

LANES_INLINE vf vf_before(vf a)
{
    return _mm512_castsi512_ps(_mm512_alignr_epi32(_mm512_castps_si512(a), _mm512_setzero_si512(), 15));
}

/* Transpose squares: each four lanes of the four vectors are one square. */
LANES_INLINE void vf_turn_squares(vf r[4])
{
    const __m512 a = _mm512_unpacklo_ps(r[0], r[1]), b = _mm512_unpackhi_ps(r[0], r[1]);
    const __m512 c = _mm512_unpacklo_ps(r[2], r[3]), d = _mm512_unpackhi_ps(r[2], r[3]);
    r[0] = _mm512_shuffle_ps(a, c, 0x44);
    r[1] = _mm512_shuffle_ps(a, c, 0xee);
    r[2] = _mm512_shuffle_ps(b, d, 0x44);
    r[3] = _mm512_shuffle_ps(b, d, 0xee);
}

/*
 * Sums over the lanes of twelve vectors: out[4*(i&3) + i/4] = sum of v[i], out[3, 7, 11, 15] = 0. Lanes i and i+8 are added,
 * then i and i+4, i+2, i+1.
 */
LANES_INLINE void vf_sums(float *out, const vf v[12])
{
    __m512 half[6], quarter[3];
#pragma GCC unroll 6
    for (int i = 0; i < 6; i++)
        half[i] = _mm512_add_ps(_mm512_shuffle_f32x4(v[2 * i], v[2 * i + 1], 0x44),
                                _mm512_shuffle_f32x4(v[2 * i], v[2 * i + 1], 0xee));
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        quarter[i] = _mm512_add_ps(_mm512_shuffle_f32x4(half[2 * i], half[2 * i + 1], 0x88),
                                   _mm512_shuffle_f32x4(half[2 * i], half[2 * i + 1], 0xdd));
    const __m512 zero = _mm512_setzero_ps();
    const __m512 a = _mm512_add_ps(_mm512_shuffle_ps(quarter[0], quarter[1], 0x44),
                                   _mm512_shuffle_ps(quarter[0], quarter[1], 0xee));
    const __m512 b = _mm512_add_ps(_mm512_shuffle_ps(quarter[2], zero, 0x44), _mm512_shuffle_ps(quarter[2], zero, 0xee));
    _mm512_store_ps(out, _mm512_add_ps(_mm512_shuffle_ps(a, b, 0x88), _mm512_shuffle_ps(a, b, 0xdd)));
}
