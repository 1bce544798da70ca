/* SPDX-License-Identifier: BSD-2-Clause */
/** \file What each camera took, in the order of time: a video, even where it came as pictures. */
#ifndef ADCGS_DATA_TRACKS_H
#define ADCGS_DATA_TRACKS_H

#include "data/scene.h"

typedef struct adcgs_tracks {
    uint32_t n;      /**< cameras that stay where they are; 1 for one that moves and took everything; 0: neither */
    uint32_t *begin; /**< [n + 1] of each in order */
    uint32_t *order; /**< [views] indices of views, camera by camera, in ascending time */
    int moves;       /**< it is one that moves */
} adcgs_tracks;

/**
 * Views whose cameras are equal to the last bit are of one that stays (by_camera.h). Where hardly two are equal, and no two were
 * taken at one time, one camera moves. Several that move cannot be told from each other: n is 0.
 */
adcgs_status adcgs_tracks_find(adcgs_tracks *tracks, const adcgs_scene_view *views, uint32_t n, adcgs_error *error);
void adcgs_tracks_clear(adcgs_tracks *tracks);

#endif
