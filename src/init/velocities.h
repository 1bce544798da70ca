/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Velocities: the points of one frame are registered to those of the adjacent frames, with similar displacements for neighbours
 * (iterative closest point, Besl and McKay 1992, A method for registration of 3-D shapes, IEEE TPAMI 14, with a displacement for
 * each point).
 */
#ifndef ADCGS_INIT_VELOCITIES_H
#define ADCGS_INIT_VELOCITIES_H

#include "init/stereo.h"

/** Sets the velocities of points [n], ascending in t. Points without a match keep 0. */
adcgs_status adcgs_stereo_find_velocities(adcgs_stereo_point *points, uint32_t n, adcgs_error *error);

#endif
