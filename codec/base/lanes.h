/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Sixteen binary32 lanes, for kernels that are written once and compiled per
 * CPU level. The including file defines ADCGS_LANES_ISA: 512 (one AVX-512
 * register), 256 (two AVX registers) or 0 (the baseline of the machine: four
 * NEON registers of 64-bit ARM, four SIMD registers of WebAssembly, else
 * portable C; ADCGS_PORTABLE forces the latter). Every operation gives the same
 * bits in all variants: minimum and maximum are `a < b ? a : b` and
 * `a > b ? a : b`, comparisons with NaN are false.
 */
#ifndef ADCGS_BASE_LANES_H
#define ADCGS_BASE_LANES_H

#include "base/fmath.h"

#if !ADCGS_LANES_ISA && defined(__aarch64__) && defined(__ARM_NEON) && !defined(ADCGS_PORTABLE)
#define LANES_NEON 1
#else
#define LANES_NEON 0
#endif
#if !ADCGS_LANES_ISA && defined(ADCGS_WASM)
#define LANES_WASM 1
#else
#define LANES_WASM 0
#endif

#if ADCGS_LANES_ISA || LANES_NEON || LANES_WASM
#define LANES_INLINE static inline __attribute__((always_inline, unused))
#else
/* Sixteen unrolled loops in a row: the compiler may choose whether to inline them. */
#define LANES_INLINE static inline __attribute__((unused))
#endif

#if ADCGS_LANES_ISA == 512
#include "base/lanes_avx512.h"
#elif ADCGS_LANES_ISA == 256
#include "base/lanes_avx2.h"
#elif LANES_NEON
#include "base/lanes_neon.h"
#elif LANES_WASM
#include "base/lanes_wasm.h"
#else
#include "base/lanes_portable.h"
#endif

/** 2^p for -126 < p < 1; any other p gives some number. Relative error 3.6e-6. */
LANES_INLINE vf vf_exp2(vf p)
{
    const vf magic = vf_set1(ADCGS_ROUND_MAGIC);
    const vf rounded = vf_add(p, magic);
    const vf f = vf_sub(p, vf_sub(rounded, magic));
    vf r = vf_fma(vf_set1(0x1.409102p-7f), f, vf_set1(0x1.ca9008p-5f));
    r = vf_fma(r, f, vf_set1(0x1.ebf1b4p-3f));
    r = vf_fma(r, f, vf_set1(0x1.62dfcap-1f));
    r = vf_fma(r, f, vf_set1(1.0f));
    return vf_scale2(r, rounded);
}

#endif
