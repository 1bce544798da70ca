/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * Flight of a camera through key frames. Smooth: position, rotation, lens and the scene's time pass through every key and change
 * their speed without a jump (cubic Hermite curves; the rotation's is the product of exponentials that has given angular
 * velocities at its ends). Keys of equal distance, in space or angle, and in time make a steady flight. What is equal in two
 * keys that follow each other stays as it is between them. Lens and time never leave the values of the keys around.
 * Linear: straight from key to key.
 */
#ifndef ADCGS_CAMERA_SPLINE_H
#define ADCGS_CAMERA_SPLINE_H

#include "camera/path.h"

typedef struct adcgs_flight_key {
    double at; /**< where on the path, in seconds or any other unit; each more than the one before */
    adcgs_shot shot;
} adcgs_flight_key;

typedef struct adcgs_knot adcgs_knot;

typedef struct adcgs_flight {
    int n, linear;
    adcgs_camera camera; /**< size and name */
    adcgs_knot *knots;
} adcgs_flight;

/**
 * n >= 1 keys with cameras of one size. closed nonzero: the last key is the first again, and the flight goes on there as it
 * began. ADCGS_ERR_MEMORY is the only failure; adcgs_flight_clear() afterwards.
 */
adcgs_status adcgs_flight_init(adcgs_flight *flight, const adcgs_flight_key *keys, int n, int linear, int closed,
                               adcgs_error *error);
/** The shot at a place, which is drawn to the first or last key if it lies outside. */
void adcgs_flight_at(const adcgs_flight *flight, double at, adcgs_shot *shot);
void adcgs_flight_clear(adcgs_flight *flight);

#endif
