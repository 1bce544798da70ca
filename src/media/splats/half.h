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

#endif
