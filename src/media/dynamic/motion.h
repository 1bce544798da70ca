/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splats that move along polynomials and fade around a centre in time: the form of SpacetimeGaussians, .splatv, FTGS, TSOG and
 * .4dgs. Readers convert to seconds, to a standard deviation with the half in the exponent, and to quaternions w x y z.
 */
#ifndef ADCGS_MEDIA_DYNAMIC_MOTION_H
#define ADCGS_MEDIA_DYNAMIC_MOTION_H

#include "media/splats/splats.h"

#define ADCGS_MOTION_ORDERS 3 /**< powers of time in a position; definition (SpacetimeGaussians) */

/**
 * At time t, with dt = t - centre: position mean + sum over j of motion[j] dt^(j+1); rotation normalised (rotation + turn dt);
 * opacity times exp(-dt^2 / (2 sigma^2)), which is 0 where that factor is below cutoff, and outside of begin <= t < end.
 * All arrays are [n] and NULL if not needed.
 */
typedef struct adcgs_motion {
    adcgs_splats base;                     /**< at dt = 0; rotations have any length > 0 */
    float *centre, *sigma;                 /**< seconds; sigma INFINITY: constant */
    float *motion[ADCGS_MOTION_ORDERS][3]; /**< units per second, second^2, second^3 */
    float *turn[4];                        /**< w x y z, per second */
    float *begin, *end;                    /**< seconds */
    float cutoff;                          /**< 0..1; 0: none */
    float *block;                          /**< memory of the arrays */
} adcgs_motion;

/** Arrays that a motion has, besides centre and sigma; definition: bits. */
enum { ADCGS_MOTION_TURNS = 1, ADCGS_MOTION_WINDOWS = 2 };

/**
 * n invisible splats of degree 0, at rest and constant: centre 0, sigma INFINITY. orders: 0 to 3 powers of motion; flags: of
 * ADCGS_MOTION_TURNS, ADCGS_MOTION_WINDOWS (-INFINITY to INFINITY).
 */
adcgs_status adcgs_motion_alloc(adcgs_motion *motion, uint64_t n, int orders, int flags, const char *path, adcgs_error *error);
/** The same for splats that exist: the motion takes them, which empties *base, also on failure. */
adcgs_status adcgs_motion_take(adcgs_motion *motion, adcgs_splats *base, int orders, int flags, const char *path,
                               adcgs_error *error);
void adcgs_motion_free(adcgs_motion *motion);
/** Change a motion that is in a unit of time of its own, of so many seconds, to seconds. */
void adcgs_motion_stretch(adcgs_motion *motion, double seconds);
/** ADCGS_ERR_DATA, naming the row, for a number that is not finite, a sigma that is not > 0, and a rotation of length 0. */
adcgs_status adcgs_motion_check(const adcgs_motion *motion, const char *path, adcgs_error *error);
/** The splats at a time in seconds: row k of the motion is splat k. Positions that leave binary32 become invisible. */
adcgs_status adcgs_motion_at(const adcgs_motion *motion, double seconds, adcgs_splats *out, const char *path, adcgs_error *error);

#endif
