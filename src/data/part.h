/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Parts of a scene in time. Each is a scene of its own, whose time begins at 0, and is learnt alone: a stream holds one segment
 * for each.
 */
#ifndef ADCGS_DATA_PART_H
#define ADCGS_DATA_PART_H

#include "data/scene.h"

/** Where a scene is cut. Zero-initialise before use. */
typedef struct adcgs_cuts {
    uint32_t n;      /**< parts */
    double *at;      /**< [n + 1] seconds, ascending: the scene's beginning, moments that training views show, its end */
    double *reach;   /**< [n] seconds that parts go on behind their ends, to such moments; 0 of the last. NULL: none */
    uint32_t moments; /**< of the part that has the fewest; those at which it begins and ends are counted */
} adcgs_cuts;

/**
 * Cut a scene at those moments of its training views that lie nearest to multiples of `seconds`, such that each part has more
 * than one; what would be less than half a part at the end is left with the last. Parts reach at most `fade` seconds into the
 * next, and a quarter of the shorter of both, for the next to be faded in meanwhile. ADCGS_ERR_DATA if the scene shows one moment
 * only.
 */
adcgs_status adcgs_cuts_find(adcgs_cuts *cuts, const adcgs_scene *scene, double seconds, double fade, adcgs_error *error);
void adcgs_cuts_clear(adcgs_cuts *cuts);

/**
 * A part, with the training views from one cut to the next and as far as it reaches, both ends included, and no others: two parts
 * share at least what the cut between them shows, so that they meet there. All else is shared with the whole scene, which must
 * stay as it is for as long.
 */
adcgs_status adcgs_scene_part(adcgs_scene *part, const adcgs_scene *whole, const adcgs_cuts *cuts, uint32_t index,
                              adcgs_error *error);
/**
 * A part without views, which its owner appends: they have paths of their own, unlike the others, and so has the part its videos.
 * All else is shared with the whole. adcgs_scene_part_free() frees it.
 */
adcgs_status adcgs_scene_part_create(adcgs_scene **part, const adcgs_scene *whole, adcgs_error *error);
void adcgs_scene_part_free(adcgs_scene **part);
/** Count the moments that its views show, once all of them and its duration are set. */
adcgs_status adcgs_scene_part_moments(adcgs_scene *part, adcgs_error *error);

/** Frees what a part has of its own. */
void adcgs_scene_part_clear(adcgs_scene *part);

#endif
