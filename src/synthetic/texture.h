/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Procedural textures of the ray tracer's objects. */
#ifndef ADCGS_SYNTHETIC_TEXTURE_H
#define ADCGS_SYNTHETIC_TEXTURE_H

#include "synthetic/trace.h"

/** The mix factor 0..1 of an object's texture at a local point. */
double adcgs_texture_mix(const adcgs_trace_object *object, const double point[3]);
/** Random number in [0,1) of a lattice point. It depends on the coordinates only: no state, no order. */
double adcgs_texture_random(int x, int y, int z, uint32_t seed);
/** Smooth noise 0..1 of unit cell size. */
double adcgs_texture_noise(const double point[3], uint32_t seed);

#endif
