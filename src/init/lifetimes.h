/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Lifetimes of matched moving points. A point is extrapolated along its velocity to adjacent frames. If most cameras show the
 * background there, the point has ended: the object is gone or has changed its path.
 */
#ifndef ADCGS_INIT_LIFETIMES_H
#define ADCGS_INIT_LIFETIMES_H

#include "base/thread_pool.h"
#include "init/fuse.h"
#include "init/rig.h"

/**
 * Sets the ends of moving points with known velocities, for static cameras. still: static depths of each camera with a
 * background, in order. A camera with a static surface in front of the point has no vote.
 */
void adcgs_stereo_trim_lifetimes(adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig, const adcgs_depths *still,
                                 adcgs_pool *pool);

#endif
