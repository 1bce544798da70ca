/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Fused multiply-add on WebAssembly, which has no such instruction of its own.
 *
 * Relaxed SIMD has a multiply-add that an engine may or may not fuse. It is used if the compiler may emit it (-mrelaxed-simd);
 * strict.h detects whether the engine fuses.
 *
 * Otherwise binary64 does the work. The product of two binary32 numbers is exact in binary64. The sum is rounded to binary64,
 * then to binary32. This double rounding is wrong in one case only: if the first rounding made, or hid, a tie for the second. So
 * if the sum lies on a tie, or is so small that binary32 has fewer digits than usual, it is rounded to odd first (Boldo and
 * Melquiond, 2008). The second rounding then sees on which side of the tie the exact sum lies.
 */
#ifndef ADCGS_BASE_FMA_WASM_H
#define ADCGS_BASE_FMA_WASM_H

#include <stdint.h>
#include <string.h>
#include <wasm_simd128.h>

#define FMA_INLINE static inline __attribute__((always_inline, unused))

#ifdef __wasm_relaxed_simd__

FMA_INLINE v128_t adcgs_fma4(v128_t a, v128_t b, v128_t c)
{
    typedef float floats __attribute__((__vector_size__(16)));
    return (v128_t)__builtin_wasm_relaxed_madd_f32x4((floats)a, (floats)b, (floats)c);
}

FMA_INLINE float adcgs_fma1(float a, float b, float c)
{
    return wasm_f32x4_extract_lane(adcgs_fma4(wasm_f32x4_splat(a), wasm_f32x4_splat(b), wasm_f32x4_splat(c)), 0);
}

#else

/* Bit masks for the halves of a binary64 number. Lower half: the bits that binary32 cuts off, and a tie of them. Upper half,
 * with the sign shifted out: the smallest exponent that is normal in binary32. */
#define FMA_CUT 0x1fffffffu
#define FMA_TIE 0x10000000u
#define FMA_NORMAL (897u << 21)

/* p + c, rounded to odd; sum: p + c rounded to nearest. The error of sum is exact (Knuth's TwoSum); for infinity it is NaN. */
static __attribute__((noinline, unused)) double adcgs_sum_to_odd(double p, double c, double sum)
{
    const double part = sum - p, error = (p - (sum - part)) + (c - part);
    uint64_t bits;
    memcpy(&bits, &sum, sizeof bits);
    if ((error < 0.0 || error > 0.0) && !(bits & 1))
        bits += (error > 0.0) == (sum > 0.0) ? 1 : (uint64_t)-1;
    memcpy(&sum, &bits, sizeof sum);
    return sum;
}

FMA_INLINE float adcgs_fma1(float a, float b, float c)
{
    const double p = (double)a * (double)b, sum = p + (double)c;
    uint64_t bits;
    memcpy(&bits, &sum, sizeof bits);
    const uint32_t low = (uint32_t)bits, high = (uint32_t)(bits >> 32);
    if ((low & FMA_CUT) == FMA_TIE || 2 * high - 1 < FMA_NORMAL - 1)
        return (float)adcgs_sum_to_odd(p, (double)c, sum);
    return (float)sum;
}

/* adcgs_sum_to_odd() for two lanes. */
static __attribute__((noinline, unused)) v128_t adcgs_sums_to_odd(v128_t p, v128_t c, v128_t sum)
{
    return wasm_f64x2_make(adcgs_sum_to_odd(wasm_f64x2_extract_lane(p, 0), wasm_f64x2_extract_lane(c, 0),
                                            wasm_f64x2_extract_lane(sum, 0)),
                           adcgs_sum_to_odd(wasm_f64x2_extract_lane(p, 1), wasm_f64x2_extract_lane(c, 1),
                                            wasm_f64x2_extract_lane(sum, 1)));
}

FMA_INLINE v128_t adcgs_fma4(v128_t a, v128_t b, v128_t c)
{
#define FMA_WIDE0(x) wasm_f64x2_promote_low_f32x4(x)
#define FMA_WIDE1(x) wasm_f64x2_promote_low_f32x4(wasm_i32x4_shuffle(x, x, 2, 3, 2, 3))
    const v128_t p0 = wasm_f64x2_mul(FMA_WIDE0(a), FMA_WIDE0(b)), p1 = wasm_f64x2_mul(FMA_WIDE1(a), FMA_WIDE1(b));
    const v128_t c0 = FMA_WIDE0(c), c1 = FMA_WIDE1(c);
    v128_t s0 = wasm_f64x2_add(p0, c0), s1 = wasm_f64x2_add(p1, c1);
    const v128_t low = wasm_i32x4_shuffle(s0, s1, 0, 2, 4, 6), high = wasm_i32x4_shuffle(s0, s1, 1, 3, 5, 7);
    const v128_t tie = wasm_i32x4_eq(wasm_v128_and(low, wasm_i32x4_splat(FMA_CUT)), wasm_i32x4_splat(FMA_TIE));
    const v128_t small =
        wasm_u32x4_lt(wasm_i32x4_sub(wasm_i32x4_shl(high, 1), wasm_i32x4_splat(1)), wasm_i32x4_splat(FMA_NORMAL - 1));
    if (wasm_v128_any_true(wasm_v128_or(tie, small))) {
        s0 = adcgs_sums_to_odd(p0, c0, s0);
        s1 = adcgs_sums_to_odd(p1, c1, s1);
    }
    return wasm_i32x4_shuffle(wasm_f32x4_demote_f64x2_zero(s0), wasm_f32x4_demote_f64x2_zero(s1), 0, 1, 4, 5);
#undef FMA_WIDE0
#undef FMA_WIDE1
}

#endif
#endif
