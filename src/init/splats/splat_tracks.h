/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Paths of single splats over the frames of splats over time. Where the source tells which splat is which, rows give them. Else
 * each splat is matched with the nearest one of the next frame in position and colour, forth and back.
 */
#ifndef ADCGS_INIT_SPLATS_SPLAT_TRACKS_H
#define ADCGS_INIT_SPLATS_SPLAT_TRACKS_H

#include "init/stereo.h"

/** All arrays are [n][frames] or as noted. Zero-initialise before use. */
typedef struct adcgs_splat_tracks {
    uint32_t n, capacity, frames;
    float *time;         /**< [frames] 0..1, ascending */
    float (*x)[3];       /**< scene units, where the track is visible */
    uint8_t *is_visible; /**< 1: the splat exists there, with an opacity of at least 0.1 */
    float (*rgb)[3];     /**< [n] */
    float (*extent)[3];  /**< [n] standard deviations along the axes, scene units */
} adcgs_splat_tracks;

/** Follows a selection of the scene's splats. origin and scale: of scene units. */
adcgs_status adcgs_splat_tracks_find(adcgs_splat_tracks *out, const adcgs_scene *scene, const adcgs_stereo_options *options,
                                     adcgs_error *error);
void adcgs_splat_tracks_clear(adcgs_splat_tracks *tracks);

/** The position of track i in a frame. */
static inline const float *adcgs_splat_track_at(const adcgs_splat_tracks *t, uint32_t i, uint32_t frame)
{
    return t->x[(size_t)i * t->frames + frame];
}
static inline int adcgs_splat_track_is_visible(const adcgs_splat_tracks *t, uint32_t i, uint32_t frame)
{
    return t->is_visible[(size_t)i * t->frames + frame];
}

#endif
