/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Parts of a scene in time. Each part is a scene of its own, whose time begins at 0, and is trained separately. A stream holds
 * one segment for each part.
 */
#ifndef ADCGS_SCENE_PART_H
#define ADCGS_SCENE_PART_H

#include "scene/scene.h"

/** The cuts of a scene. Zero-initialise before use. */
typedef struct adcgs_cuts {
    uint32_t n;       /**< parts */
    double *at;       /**< [n + 1] seconds, ascending: the scene's beginning, times of training views, its end */
    double *reach;    /**< [n] seconds from a part's end to the last training view that it also takes; 0 for the last; or NULL */
    uint32_t moments; /**< distinct times of the part with the fewest, including its beginning and end */
} adcgs_cuts;

/**
 * Cuts a scene at the times of training views nearest to multiples of `seconds`. Each part has more than one time. A remainder
 * of less than half a part stays with the last part. Parts extend into the next part for a crossfade, by at most `fade` seconds
 * and at most a quarter of the shorter of both parts. ADCGS_ERR_DATA if the scene has only one distinct time.
 */
adcgs_status adcgs_cuts_find(adcgs_cuts *cuts, const adcgs_scene *scene, double seconds, double fade, adcgs_error *error);
void adcgs_cuts_clear(adcgs_cuts *cuts);

/**
 * Makes a part with the training views from one cut to the next, plus its extension, both ends included, and no other views.
 * Two parts share at least the views at the cut between them, so that they agree there. Everything else is shared with the
 * whole scene, which must stay unchanged while the part exists.
 */
adcgs_status adcgs_scene_part(adcgs_scene *part, const adcgs_scene *whole, const adcgs_cuts *cuts, uint32_t index,
                              adcgs_error *error);
/**
 * Makes a part without views, to which its owner appends views. Unlike parts from adcgs_scene_part(), this part owns the paths
 * of its views, and its videos. Everything else is shared with the whole scene. Free it with adcgs_scene_part_free().
 */
adcgs_status adcgs_scene_part_create(adcgs_scene **part, const adcgs_scene *whole, adcgs_error *error);
void adcgs_scene_part_free(adcgs_scene **part);
/** Sets n_times from its views. Call it after all views and the duration are set. */
adcgs_status adcgs_scene_part_count_times(adcgs_scene *part, adcgs_error *error);

/** Frees the memory that the part owns. */
void adcgs_scene_part_clear(adcgs_scene *part);

#endif
