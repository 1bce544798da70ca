/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Splines of a camera through key frames. Smooth: position, rotation, lens and the scene's time pass through every key and change
 * their speed without a jump. Keys of equal distance, in space or angle, and in time make a steady motion. What is equal in two
 * keys that follow each other stays as it is between them. Lens and time never leave the values of the keys around.
 * Linear: straight from key to key.
 *
 * Known as: cubic Hermite splines, for positions with the rates of parabolas through three keys (with even keys, Catmull and Rom,
 * 1974), for single numbers with those that keep them monotone (Fritsch and Carlson, 1980; the weighted harmonic mean is Fritsch
 * and Butland's, 1984); for rotations, products of exponentials of cumulative Bernstein polynomials (Kim, Kim and Shin, 1995, "A
 * General Construction Scheme for Unit Quaternion Curves with Simple High Order Derivatives"); linear, slerp (Shoemake, 1985).
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
 * n >= 1 keys with cameras of one size. closed nonzero: the last key is the first again, and the spline goes on there as it
 * began. ADCGS_ERR_MEMORY is the only failure; adcgs_camera_spline_clear() afterwards.
 */
adcgs_status adcgs_camera_spline_init(adcgs_camera_spline *spline, const adcgs_camera_key *keys, int n, int linear, int closed,
                               adcgs_error *error);
/** The frame at a place, which is drawn to the first or last key if it lies outside. */
void adcgs_camera_spline_at(const adcgs_camera_spline *spline, double at, adcgs_camera_frame *frame);
void adcgs_camera_spline_clear(adcgs_camera_spline *spline);

#endif
