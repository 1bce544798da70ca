/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Positions far from the world's origin (earth-centred or map coordinates in
 * metres) in files of binary32. They are stored relative to an offset.
 */
#ifndef ADCGS_MEDIA_SPLATS_OFFSET_H
#define ADCGS_MEDIA_SPLATS_OFFSET_H

#include "base/base.h"

#include <math.h>

/**
 * Distance of the origin in units of the scene's scale. Beyond it binary32, in steps of 2^-23 of a value, is coarser than 2^-15
 * of the scale: arithmetic. The bound of 2^-15 is chosen by hand, not measured.
 */
#define ADCGS_OFFSET_FAR 256.0

/**
 * The offset for a scene of this origin and scale. It is zero for a near origin, else the origin rounded to multiples of a power
 * of two near the scale. \return true if the origin is far.
 */
static inline int adcgs_offset_of(double offset[3], const double origin[3], double scale)
{
    const double step = exp2(floor(log2(scale > 0.0 ? scale : 1.0)));
    const int is_far = fmax(fabs(origin[0]), fmax(fabs(origin[1]), fabs(origin[2]))) > ADCGS_OFFSET_FAR * scale;
    for (int a = 0; a < 3; a++)
        offset[a] = is_far ? step * rint(origin[a] / step) : 0.0;
    return is_far;
}

/** True if the offset is not zero. */
static inline int adcgs_offset_is(const double offset[3])
{
    return offset[0] != 0.0 || offset[1] != 0.0 || offset[2] != 0.0;
}

#endif
