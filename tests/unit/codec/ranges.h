/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers over the whole of a range: equally many of each power of two, and the limits themselves often. */
#ifndef TESTS_RANGES_H
#define TESTS_RANGES_H

#include "base/fmath.h"
#include "unit/pixels_scene.h"

static inline int ranges_chance(uint64_t *state, double p)
{
    return scene_uniform(state) < p;
}

/** Between 2^low and 2^high; each limit once in ten times. */
static inline double ranges_size(uint64_t *state, double low, double high)
{
    const double at = 1.25 * scene_uniform(state) - 0.125;
    return exp2(at < 0 ? low : at > 1 ? high : low + at * (high - low));
}

/** The same with either sign, or 0. */
static inline double ranges_signed(uint64_t *state, double low, double high)
{
    const double x = ranges_chance(state, 0.05) ? 0.0 : ranges_size(state, low, high);
    return ranges_chance(state, 0.5) ? -x : x;
}

/** Uniform between two numbers; each limit once in ten times. */
static inline double ranges_between(uint64_t *state, double low, double high)
{
    const double at = 1.25 * scene_uniform(state) - 0.125;
    return at < 0 ? low : at > 1 ? high : low + at * (high - low);
}

/** `opacity_of` of the specification. */
static inline float ranges_opacity_of(float power)
{
    const float m = power + ADCGS_ROUND_MAGIC, f = power - (m - ADCGS_ROUND_MAGIC);
    float p = fmaf(0x1.409102p-7f, f, 0x1.ca9008p-5f);
    p = fmaf(p, f, 0x1.ebf1b4p-3f);
    p = fmaf(p, f, 0x1.62dfcap-1f);
    return adcgs_scale2(fmaf(p, f, 1.0f), m);
}

#endif
