/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Faults of footage that times and pictures at a glance show before anything is learnt. What is looked for is rare in footage in
 * order: where it could be either, nothing is found.
 */
#ifndef ADCGS_DATA_FAULTS_H
#define ADCGS_DATA_FAULTS_H

#include "data/glance.h"
#include "data/tracks.h"

/** What was found. Times are those of the views. */
typedef struct adcgs_fault {
    uint32_t cameras;             /**< that have it; 0: none has */
    uint32_t of;                  /**< cameras that could be judged; of one that moves and took everything 1 */
    const char *path;             /**< of the view where it begins, of the camera that has it worst; NULL: all have it */
    uint32_t count;               /**< times that camera has it */
    double from, to;              /**< where it is worst */
    double size;                  /**< how bad it is there; see the functions */
    adcgs_glance_light light;     /**< of a step of light, what pictures become */
} adcgs_fault;

/**
 * No picture for a time in which others of the camera came regularly. Views of all splits count as taken. If nobody took anything
 * in that time, cameras and of are equal. size: pictures that are missing, by the median step.
 */
adcgs_status adcgs_fault_gaps(adcgs_fault *fault, const adcgs_scene *scene, adcgs_error *error);

/**
 * Pictures that are the one before once more, while those around differ. tracks, glances: of these views, here and below. count
 * and path are of the camera that has most; size: how many all cameras have. shows: [views] of these pictures the view that they
 * are of becomes the one before; others stay as they are; or NULL.
 */
void adcgs_fault_doubled(adcgs_fault *fault, uint32_t *shows, const adcgs_scene_view *views, const adcgs_tracks *tracks,
                         const adcgs_glance *glances);

/**
 * Pictures that are those before them in time once more, but of another camera, whose pictures are others. path is the first of
 * them; count: how many one camera has at most; size: how many all have. Of one camera nothing is said.
 */
adcgs_status adcgs_fault_copied(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_tracks *tracks,
                                const adcgs_glance *glances, adcgs_error *error);

/**
 * A camera's pictures are all brighter or darker, or redder or bluer, by one factor from one moment on, or at one moment. size:
 * the factor. cameras are those that have one at the same time. behind: [views] of those behind any such step of their camera
 * become 1, at both ends of a flash; others stay as they are; or NULL.
 */
adcgs_status adcgs_fault_light(adcgs_fault *fault, uint8_t *behind, const adcgs_scene_view *views, const adcgs_tracks *tracks,
                               const adcgs_glance *glances, adcgs_error *error);

/** Changes of a camera's pictures come as those of all others do, but at other moments. size: seconds that it is late. */
adcgs_status adcgs_fault_clocks(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_tracks *tracks,
                                const adcgs_glance *glances, adcgs_error *error);

#endif
