/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What moves, where cameras stand too far apart for matching: the hull of its silhouettes (Laurentini 1994, The visual hull
 * concept for silhouette-based image understanding, IEEE TPAMI 16), found by halving cubes (Szeliski 1993, Rapid octree
 * construction from image sequences, CVGIP 58). Its surface is that of the thing or before it, and has the colour of a view that
 * sees it.
 */
#ifndef ADCGS_STEREO_HULL_H
#define ADCGS_STEREO_HULL_H

#include "stereo/fuse.h"

/**
 * Add the surface's points that any view sees, each about a pixel wide. moves: for each view [h][w], 1 where it shows what moves.
 * like: what all points are but place, colour, size and detail.
 */
adcgs_status adcgs_hull_find(adcgs_stereo_list *list, const adcgs_stereo_view *views, const uint8_t *const *moves, int n,
                             const adcgs_stereo_point *like, adcgs_error *error);

#endif
