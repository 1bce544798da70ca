/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Splines of a camera through key frames. Smooth: position, rotation, lens and
 * the scene's time pass through every key, with continuous speed. Keys at equal
 * distances, in space or angle, and in time give a steady motion. A value that
 * is equal in two successive keys is constant between them. Lens and time never
 * leave the range of the neighbouring keys. Linear: straight from key to key.
 *
 * Known as cubic Hermite splines. Positions have the rates of parabolas through
 * three keys (with even keys, Catmull and Rom, 1974). Single numbers have the
 * rates that keep them monotone (Fritsch and Carlson, 1980; the weighted
 * harmonic mean is Fritsch and Butland's, 1984). Rotations are products of
 * exponentials of cumulative Bernstein polynomials (Kim, Kim and Shin, 1995, "A
 * General Construction Scheme for Unit Quaternion Curves with Simple High Order
 * Derivatives"). Linear rotation is slerp (Shoemake, 1985).
 */
#ifndef ADCGS_CAMERA_SPLINE_H
#define ADCGS_CAMERA_SPLINE_H

#include "camera/path.h"

typedef struct adcgs_knot adcgs_knot;

typedef struct adcgs_camera_spline {
    int n, linear;
    adcgs_camera camera; /**< size and name */
    adcgs_knot *knots;
} adcgs_camera_spline;

/**
 * n >= 1 keys with cameras of one size. closed nonzero: the last key equals the first, and the spline is periodic there.
 * ADCGS_ERR_MEMORY is the only failure. Call adcgs_camera_spline_clear() afterwards.
 */
adcgs_status adcgs_camera_spline_init(adcgs_camera_spline *spline, const adcgs_camera_key *keys, int n, int linear, int closed,
                                      adcgs_error *error);
/** The frame at a position, which is clamped to the first and last key. */
void adcgs_camera_spline_at(const adcgs_camera_spline *spline, double at, adcgs_camera_frame *frame);
void adcgs_camera_spline_clear(adcgs_camera_spline *spline);

#endif
