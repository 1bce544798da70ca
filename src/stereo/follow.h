/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Velocities: points of one moment are laid onto those of the next, neighbours alike (iterated closest points, Besl and McKay
 * 1992, A method for registration of 3-D shapes, IEEE TPAMI 14, with a displacement of its own for each point).
 */
#ifndef ADCGS_STEREO_FOLLOW_H
#define ADCGS_STEREO_FOLLOW_H

#include "stereo/stereo.h"

/** Set the velocity of points [n], ascending in t. Those without a match keep 0. */
adcgs_status adcgs_stereo_follow(adcgs_stereo_point *points, uint32_t n, adcgs_error *error);

#endif
