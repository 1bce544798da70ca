/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Faults of footage that are detected from timestamps and thumbnails before training. The detected patterns are rare in correct
 * footage. An ambiguous pattern is not reported.
 */
#ifndef ADCGS_CHECK_FAULTS_H
#define ADCGS_CHECK_FAULTS_H

#include "scene/camera_order.h"
#include "scene/thumbnail_stats.h"

/** A detected fault. Times are those of the views. */
typedef struct adcgs_fault {
    uint32_t cameras;            /**< cameras with the fault; 0: none */
    uint32_t of;                 /**< cameras that could be judged; 1 for one moving camera that took everything */
    const char *path;            /**< of the view where it begins, in the worst affected camera; NULL: all cameras have it */
    uint32_t count;              /**< occurrences in this camera */
    double from, to;             /**< times of the worst occurrence */
    double size;                 /**< severity of the worst occurrence; see the functions */
    adcgs_thumbnail_light light; /**< kind of change, for a step of light */
} adcgs_fault;

/**
 * Finds times without an image from a camera whose other images are regular. Views of all splits count as taken. If no camera
 * took an image in a gap, cameras equals of. size: number of missing images, by the median step.
 */
adcgs_status adcgs_fault_gaps(adcgs_fault *fault, const adcgs_scene *scene, adcgs_error *error);

/**
 * Finds duplicate frames: images that repeat the previous image of their camera, while the images around them differ. tracks,
 * thumbnails: of these views, here and below. count and path: of the camera with most duplicates; size: their total over all
 * cameras. shows: [views], or NULL; for each duplicate, its entry becomes the view that it repeats. Other entries are
 * unchanged.
 */
void adcgs_fault_duplicates(adcgs_fault *fault, uint32_t *shows, const adcgs_scene_view *views, const adcgs_camera_order *tracks,
                            const adcgs_thumbnail *thumbnails);

/**
 * Finds images that repeat the previous image in time, which another camera took, while other images of both cameras differ.
 * path: the first copy; count: the most copies in one camera; size: their total. A single camera is never reported.
 */
adcgs_status adcgs_fault_copied(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_camera_order *tracks,
                                const adcgs_thumbnail *thumbnails, adcgs_error *error);

/**
 * Finds steps of light: from one time on, or at one time, all images of a camera are brighter or darker, or redder or bluer, by
 * one factor. size: the factor. cameras: those with a step at the same time. behind: [views], or NULL; views behind any step of
 * their camera become 1, at both ends of a flash. Other entries are unchanged.
 */
adcgs_status adcgs_fault_light(adcgs_fault *fault, uint8_t *behind, const adcgs_scene_view *views,
                               const adcgs_camera_order *tracks, const adcgs_thumbnail *thumbnails, adcgs_error *error);

/** Finds a camera whose changes match those of all other cameras, but at other times. size: seconds by which it is late. */
adcgs_status adcgs_fault_clocks(adcgs_fault *fault, const adcgs_scene_view *views, const adcgs_camera_order *tracks,
                                const adcgs_thumbnail *thumbnails, adcgs_error *error);

#endif
