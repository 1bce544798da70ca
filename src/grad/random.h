/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Counter-based random numbers: a value is a pure function of (seed, stream,
 * counter), so training does not depend on threads and resumes exactly.
 */
#ifndef ADCGS_GRAD_RANDOM_H
#define ADCGS_GRAD_RANDOM_H

#include <stdint.h>

/** 32-bit finaliser with full avalanche (two rounds of xor-shift and multiply). */
static inline uint32_t adcgs_mix32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/** 64-bit finaliser (splitmix64's constants). */
static inline uint64_t adcgs_mix64(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static inline uint64_t adcgs_random64(uint64_t seed, uint64_t stream, uint64_t counter)
{
    return adcgs_mix64(adcgs_mix64(seed + 0x632be59bd9b4e019u * stream) ^ counter);
}

/** Uniform in [0, 1). */
static inline double adcgs_random_unit(uint64_t seed, uint64_t stream, uint64_t counter)
{
    return (double)(adcgs_random64(seed, stream, counter) >> 11) * 0x1p-53;
}

/** Approximately normal, mean 0, variance 1: the sum of four uniforms; sufficient for initial weights. */
static inline double adcgs_random_normal(uint64_t seed, uint64_t stream, uint64_t counter)
{
    const uint64_t r = adcgs_random64(seed, stream, counter);
    const double sum = (double)(r & 0xffff) + (double)(r >> 16 & 0xffff) + (double)(r >> 32 & 0xffff) + (double)(r >> 48);
    return (sum * 0x1p-16 - 2.0) * 1.7320508075688772;
}

#endif
