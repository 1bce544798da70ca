/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Sixteen lanes in two AVX registers; see lanes.h. */
#include <immintrin.h>

typedef struct vf {
    __m256 a, b;
} vf;
typedef vf vm;

LANES_INLINE vf vf_set1(float x) { return (vf){_mm256_set1_ps(x), _mm256_set1_ps(x)}; }
LANES_INLINE vf vf_load(const float *p) { return (vf){_mm256_load_ps(p), _mm256_load_ps(p + 8)}; }
LANES_INLINE vf vf_loadu(const float *p) { return (vf){_mm256_loadu_ps(p), _mm256_loadu_ps(p + 8)}; }
LANES_INLINE vf vf_add(vf x, vf y) { return (vf){_mm256_add_ps(x.a, y.a), _mm256_add_ps(x.b, y.b)}; }
LANES_INLINE vf vf_sub(vf x, vf y) { return (vf){_mm256_sub_ps(x.a, y.a), _mm256_sub_ps(x.b, y.b)}; }
LANES_INLINE vf vf_mul(vf x, vf y) { return (vf){_mm256_mul_ps(x.a, y.a), _mm256_mul_ps(x.b, y.b)}; }
LANES_INLINE vf vf_div(vf x, vf y) { return (vf){_mm256_div_ps(x.a, y.a), _mm256_div_ps(x.b, y.b)}; }
LANES_INLINE vf vf_sqrt(vf x) { return (vf){_mm256_sqrt_ps(x.a), _mm256_sqrt_ps(x.b)}; }
LANES_INLINE vf vf_min(vf x, vf y) { return (vf){_mm256_min_ps(x.a, y.a), _mm256_min_ps(x.b, y.b)}; }
LANES_INLINE vf vf_max(vf x, vf y) { return (vf){_mm256_max_ps(x.a, y.a), _mm256_max_ps(x.b, y.b)}; }
LANES_INLINE int vm_any(vm m) { return _mm256_movemask_ps(_mm256_or_ps(m.a, m.b)) != 0; }
LANES_INLINE vf vf_only(vm m, vf x) { return (vf){_mm256_and_ps(m.a, x.a), _mm256_and_ps(m.b, x.b)}; }

LANES_INLINE vf vf_load_once(const float *p) { return vf_load(p); }

LANES_INLINE void vf_store(float *p, vf x)
{
    _mm256_store_ps(p, x.a);
    _mm256_store_ps(p + 8, x.b);
}

LANES_INLINE void vf_storeu(float *p, vf x)
{
    _mm256_storeu_ps(p, x.a);
    _mm256_storeu_ps(p + 8, x.b);
}

LANES_INLINE vf vf_fma(vf x, vf y, vf z)
{
    return (vf){_mm256_fmadd_ps(x.a, y.a, z.a), _mm256_fmadd_ps(x.b, y.b, z.b)};
}

LANES_INLINE vf vf_fnma(vf x, vf y, vf z)
{
    return (vf){_mm256_fnmadd_ps(x.a, y.a, z.a), _mm256_fnmadd_ps(x.b, y.b, z.b)};
}

LANES_INLINE vf vf_abs(vf x)
{
    const __m256 sign = _mm256_set1_ps(-0.0f);
    return (vf){_mm256_andnot_ps(sign, x.a), _mm256_andnot_ps(sign, x.b)};
}

LANES_INLINE vm vf_ge(vf x, vf y)
{
    return (vm){_mm256_cmp_ps(x.a, y.a, _CMP_GE_OQ), _mm256_cmp_ps(x.b, y.b, _CMP_GE_OQ)};
}

LANES_INLINE vf vf_where(vm m, vf x, vf otherwise)
{
    return (vf){_mm256_blendv_ps(otherwise.a, x.a, m.a), _mm256_blendv_ps(otherwise.b, x.b, m.b)};
}

LANES_INLINE vf vf_fma_where(vm m, vf x, vf y, vf z) { return vf_where(m, vf_fma(x, y, z), z); }
LANES_INLINE vf vf_fnma_where(vm m, vf x, vf y, vf z) { return vf_where(m, vf_fnma(x, y, z), z); }

LANES_INLINE __m256 half_scale2(__m256 p, __m256 rounded)
{
    return _mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(p), _mm256_slli_epi32(_mm256_castps_si256(rounded), 23)));
}

LANES_INLINE vf vf_scale2(vf p, vf rounded)
{
    return (vf){half_scale2(p.a, rounded.a), half_scale2(p.b, rounded.b)};
}

LANES_INLINE void vf_store_int(int32_t *p, vf x)
{
    _mm256_store_si256((__m256i *)p, _mm256_cvttps_epi32(x.a));
    _mm256_store_si256((__m256i *)(p + 8), _mm256_cvttps_epi32(x.b));
}

LANES_INLINE void vf_store_rows(float *const row[4], vf x)
{
    _mm_storeu_ps(row[0], _mm256_castps256_ps128(x.a));
    _mm_storeu_ps(row[1], _mm256_extractf128_ps(x.a, 1));
    _mm_storeu_ps(row[2], _mm256_castps256_ps128(x.b));
    _mm_storeu_ps(row[3], _mm256_extractf128_ps(x.b, 1));
}

LANES_INLINE vf vf_load_rows(const float *p, size_t stride)
{
    return (vf){_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p + stride), 1),
                _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 2 * stride)), _mm_loadu_ps(p + 3 * stride), 1)};
}

LANES_INLINE __m256 half_align(__m256 high, __m256 low, const int odd)
{
    const __m256i h = _mm256_castps_si256(high), l = _mm256_castps_si256(low);
    return _mm256_castsi256_ps(odd ? _mm256_alignr_epi8(h, l, 12) : _mm256_alignr_epi8(h, l, 4));
}

LANES_INLINE vf vf_next(vf x)
{
    return (vf){half_align(_mm256_permute2f128_ps(x.a, x.b, 0x21), x.a, 0),
                half_align(_mm256_permute2f128_ps(x.b, x.b, 0x81), x.b, 0)};
}

LANES_INLINE vf vf_before(vf x)
{
    return (vf){half_align(x.a, _mm256_permute2f128_ps(x.a, x.a, 0x08), 1),
                half_align(x.b, _mm256_permute2f128_ps(x.a, x.b, 0x21), 1)};
}

LANES_INLINE void half_turn(__m256 *r0, __m256 *r1, __m256 *r2, __m256 *r3)
{
    const __m256 a = _mm256_unpacklo_ps(*r0, *r1), b = _mm256_unpackhi_ps(*r0, *r1);
    const __m256 c = _mm256_unpacklo_ps(*r2, *r3), d = _mm256_unpackhi_ps(*r2, *r3);
    *r0 = _mm256_shuffle_ps(a, c, 0x44);
    *r1 = _mm256_shuffle_ps(a, c, 0xee);
    *r2 = _mm256_shuffle_ps(b, d, 0x44);
    *r3 = _mm256_shuffle_ps(b, d, 0xee);
}

LANES_INLINE void vf_turn_squares(vf r[4])
{
    half_turn(&r[0].a, &r[1].a, &r[2].a, &r[3].a);
    half_turn(&r[0].b, &r[1].b, &r[2].b, &r[3].b);
}

/* See lanes_avx512.h. Computes two of the four columns of sums at a time. */
LANES_INLINE __m256 half_sums(const vf *v)
{
    __m256 quarter[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const __m256 x = _mm256_add_ps(v[4 * i].a, v[4 * i].b), y = _mm256_add_ps(v[4 * i + 1].a, v[4 * i + 1].b);
        quarter[i] = _mm256_add_ps(_mm256_permute2f128_ps(x, y, 0x20), _mm256_permute2f128_ps(x, y, 0x31));
    }
    const __m256 zero = _mm256_setzero_ps();
    const __m256 a = _mm256_add_ps(_mm256_shuffle_ps(quarter[0], quarter[1], 0x44),
                                   _mm256_shuffle_ps(quarter[0], quarter[1], 0xee));
    const __m256 b = _mm256_add_ps(_mm256_shuffle_ps(quarter[2], zero, 0x44), _mm256_shuffle_ps(quarter[2], zero, 0xee));
    return _mm256_add_ps(_mm256_shuffle_ps(a, b, 0x88), _mm256_shuffle_ps(a, b, 0xdd));
}

LANES_INLINE void vf_sums(float *out, const vf v[12])
{
    _mm256_store_ps(out, half_sums(v));
    _mm256_store_ps(out + 8, half_sums(v + 2));
}
