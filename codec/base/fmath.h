/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Elementary functions in strict binary32 (spec clause "Elementary functions"):
 * the same bits on every CPU and compiler. Each is straight-line code of
 * additions, multiplications, fused multiply-adds, divisions and selections, so
 * a loop over 64 lanes vectorises. Arguments outside the domain are clamped; no
 * argument but NaN gives NaN.
 */
#ifndef ADCGS_BASE_FMATH_H
#define ADCGS_BASE_FMATH_H

#include "base/base.h"

#include <math.h>

/* The C library's function would be an expensive call here; this one gives the same numbers inline. */
#ifdef ADCGS_WASM
#include "base/fma_wasm.h"
#define fmaf adcgs_fma1
#endif

/* Adding and subtracting 1.5 * 2^23 rounds to an integer; its low bits are then in the sum's significand. */
#define ADCGS_ROUND_MAGIC 0x1.8p23f

static inline float adcgs_clampf(float x, float lo, float hi)
{
    const float y = x < lo ? lo : x;
    return hi < y ? hi : y;
}

/* 2^f for |f| <= 1/2; relative error of the polynomial: 2.6e-9. */
static inline float adcgs_exp2_poly(float f)
{
    float p = 0x1.470b48p-13f;
    p = fmaf(p, f, 0x1.5f7276p-10f);
    p = fmaf(p, f, 0x1.3b270ep-7f);
    p = fmaf(p, f, 0x1.c6ae72p-5f);
    p = fmaf(p, f, 0x1.ebfbe2p-3f);
    p = fmaf(p, f, 0x1.62e432p-1f);
    return fmaf(p, f, 1.0f);
}

/* p * 2^n; rounded is n + magic, and the result must be normal. */
static inline float adcgs_scale2(float p, float rounded)
{
    return adcgs_bits_float(adcgs_float_bits(p) + (adcgs_float_bits(rounded) << 23));
}

/** 2^x, x clamped to [-125, 127]; relative error below 1.0e-7. */
static inline float adcgs_exp2(float x)
{
    const float y = adcgs_clampf(x, -125.0f, 127.0f);
    const float rounded = y + ADCGS_ROUND_MAGIC;
    const float f = y - (rounded - ADCGS_ROUND_MAGIC);
    return adcgs_scale2(adcgs_exp2_poly(f), rounded);
}

/** e^x, x clamped to [-86, 88]; relative error below 1.5e-7. */
static inline float adcgs_exp(float x)
{
    const float y = adcgs_clampf(x, -86.0f, 88.0f);
    const float rounded = fmaf(y, 0x1.715476p+0f, ADCGS_ROUND_MAGIC);
    const float n = rounded - ADCGS_ROUND_MAGIC;
    const float f = fmaf(y, 0x1.4ae0c0p-26f, fmaf(y, 0x1.715476p+0f, -n));
    return adcgs_scale2(adcgs_exp2_poly(f), rounded);
}

/** 1 / (1 + e^-x), x clamped to [-32, 32]; relative error below 2.5e-7. */
static inline float adcgs_sigmoid(float x)
{
    return 1.0f / (1.0f + adcgs_exp(-adcgs_clampf(x, -32.0f, 32.0f)));
}

/** log2(x) for a positive normal x; error below 1.0e-7 * max(1, |log2 x|). */
static inline float adcgs_log2(float x)
{
    const uint32_t bits = adcgs_float_bits(x);
    /* e is chosen so that x = m 2^e with m in [sqrt(1/2), sqrt(2)). */
    const uint32_t biased = (bits + (0x3f800000u - 0x3f3504f3u)) >> 23;
    const float m = adcgs_bits_float(bits - ((biased - 127u) << 23));
    const float t = (m - 1.0f) / (m + 1.0f);
    const float s = t * t;
    float p = 0x1.ba18f8p-2f;
    p = fmaf(p, s, 0x1.27471cp-1f);
    p = fmaf(p, s, 0x1.ec70e6p-1f);
    p = fmaf(p, s, 0x1.715476p+1f);
    return fmaf(t, p, (float)((int32_t)biased - 127));
}

/** sin(pi x) and cos(pi x) for |x| <= 2^20; error below 1.2e-7. */
static inline void adcgs_sincospi(float x, float *sine, float *cosine)
{
    const float rounded = fmaf(x, 2.0f, ADCGS_ROUND_MAGIC);
    const float r = fmaf(rounded - ADCGS_ROUND_MAGIC, -0.5f, x);
    const float s = r * r;
    float p = -0x1.2d9302p-1f;
    p = fmaf(p, s, 0x1.465e92p+1f);
    p = fmaf(p, s, -0x1.4abbbap+2f);
    p = fmaf(p, s, 0x1.921fb6p+1f);
    const float sin_r = r * p;
    float q = 0x1.d9f7bcp-3f;
    q = fmaf(q, s, -0x1.55c664p+0f);
    q = fmaf(q, s, 0x1.03c1dep+2f);
    q = fmaf(q, s, -0x1.3bd3ccp+2f);
    const float cos_r = fmaf(q, s, 1.0f);
    /* Quarter turns: an odd number swaps the two; the second bit and the swap give the signs. */
    const uint32_t quarter = adcgs_float_bits(rounded);
    const uint32_t odd = quarter & 1u, sign_sine = (quarter & 2u) << 30, sign_cosine = ((quarter + 1u) & 2u) << 30;
    const float a = odd ? cos_r : sin_r, b = odd ? sin_r : cos_r;
    *sine = adcgs_bits_float(adcgs_float_bits(a) ^ sign_sine);
    *cosine = adcgs_bits_float(adcgs_float_bits(b) ^ sign_cosine);
}

#endif
