/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * How long what matching found at a moment stays as it goes: a point that were still there a moment on, along its way, would hide
 * what pictures usually show. Where most cameras show just that, it has ended: it is gone, or went elsewhere.
 */
#ifndef ADCGS_STEREO_LIVES_H
#define ADCGS_STEREO_LIVES_H

#include "base/pool.h"
#include "stereo/fuse.h"
#include "stereo/rig.h"

/**
 * Set the ends of points that move, whose velocities are known, before cameras that stay. still: of each camera that usually
 * shows something, in their order, depths of that; who sees it before a place says nothing of it.
 */
void adcgs_stereo_find_ends(adcgs_stereo_point *points, uint32_t n, const adcgs_stereo_rig *rig,
                            const adcgs_depths *still, adcgs_pool *pool);

#endif
