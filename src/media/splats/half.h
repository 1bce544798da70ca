/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Numbers of binary16 in files. */
#ifndef ADCGS_MEDIA_SPLATS_HALF_H
#define ADCGS_MEDIA_SPLATS_HALF_H

#include "base/base.h"

#include <math.h>

/** A little-endian binary16, which may be infinite or NaN. */
static inline double adcgs_load_half(const uint8_t *at)
{
    const unsigned bits = adcgs_load_le16(at), exponent = bits >> 10 & 31, fraction = bits & 1023;
    const double size = exponent == 31 ? (fraction ? NAN : INFINITY)
                        : exponent     ? ldexp(1024.0 + fraction, (int)exponent - 25)
                                       : ldexp(fraction, -24);
    return bits & 0x8000 ? -size : size;
}

/** Store the nearest little-endian binary16, ties to even; values above 65504 become 65504. NaN becomes 0. */
static inline void adcgs_store_half(uint8_t *to, double value)
{
    const double size = fmin(fabs(isnan(value) ? 0.0 : value), 65504.0);
    int exponent;
    frexp(size, &exponent); /* size = fraction 2^exponent, with a fraction of at least 1/2 */
    const int step = size > 0.0 && exponent > -13 ? exponent - 11 : -24;
    const unsigned bits = (unsigned)rint(ldexp(size, -step)) + (step > -24 ? (unsigned)(step + 24) << 10 : 0);
    adcgs_store_le16(to, (uint16_t)(bits | (signbit(value) ? 0x8000u : 0u)));
}

#endif
