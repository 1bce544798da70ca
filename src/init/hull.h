/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Moving content where the cameras are too far apart for matching: the visual hull of its silhouettes (Laurentini 1994, The
 * visual hull concept for silhouette-based image understanding, IEEE TPAMI 16), built by halving cubes (Szeliski 1993, Rapid
 * octree construction from image sequences, CVGIP 58). The hull's surface lies on the object or in front of it, and gets its
 * colours from views that see it.
 */
#ifndef ADCGS_INIT_HULL_H
#define ADCGS_INIT_HULL_H

#include "init/fuse.h"

/**
 * Adds the surface points that any view sees, each about one pixel wide. moves: for each view [h][w], 1 at moving pixels. like:
 * all point members except position, colour, size and detail.
 */
adcgs_status adcgs_hull_find(adcgs_stereo_list *list, const adcgs_stereo_view *views, const uint8_t *const *moves, int n,
                             const adcgs_stereo_point *like, adcgs_error *error);

#endif
