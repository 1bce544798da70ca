/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Intersection of rays with shapes. */
#ifndef ADCGS_SYNTHETIC_SHAPES_H
#define ADCGS_SYNTHETIC_SHAPES_H

#include "synthetic/trace.h"

#define ADCGS_SHAPES_FAR 1e30 /* scene units: beyond everything; arithmetic */

/**
 * Smallest t > 0 where the ray o + t d meets the object, in its local coordinates, and the normal there; else ADCGS_SHAPES_FAR.
 */
double adcgs_shapes_hit(const adcgs_trace_object *object, const double o[3], const double d[3], double normal[3]);
/** Squared radius of a ball about the origin of local coordinates that holds the object. */
double adcgs_shapes_bound2(const adcgs_trace_object *object);

#endif
