/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Tracking of one rigid body from the frame of its seed to all others. Initial poses are the continuation of the motion, and
 * rotations about it. Of the best fits, the tracker takes the pose with the best agreement of the images. The body collects
 * points of all frames, so that sides that come into view join it. Points that do not follow the motion are dropped.
 */
#ifndef ADCGS_INIT_RIGID_TRACK_H
#define ADCGS_INIT_RIGID_TRACK_H

#include "init/rigid/layers.h"

/** A body and its poses. Zero-initialise before use. */
typedef struct adcgs_track {
    adcgs_body_model model;
    adcgs_placement place[ADCGS_MATCHING_FRAMES_MAX];
    uint8_t known[ADCGS_MATCHING_FRAMES_MAX];
} adcgs_track;

/** Tracks the model, which is at rest in frame `start`, to all other frames. */
adcgs_status adcgs_track_run(adcgs_track *track, const adcgs_layers *layers, int start, adcgs_pool *pool, adcgs_error *error);

/** Where the track was lost or jumped, tests if the body continued its motion. */
void adcgs_track_rematch(adcgs_track *track, const adcgs_layers *layers, int start);

/** Refines the pose of all frames against the whole body. */
void adcgs_track_refine(adcgs_track *track, const adcgs_layers *layers, adcgs_pool *pool);

/** RMS distance between the positions of a body's points under two poses. */
double adcgs_track_between(const adcgs_track *track, const adcgs_rigid *a, const adcgs_rigid *b);

/** Extrapolates the motion between two frames with a known pose; known[0] is the nearer one. */
void adcgs_track_extrapolate(const adcgs_track *track, const adcgs_layers *layers, int frame, const int known[2],
                             adcgs_rigid *out);

/** Centroid of the body's points in its rest pose. Returns their RMS distance from it. */
double adcgs_track_centre(const adcgs_track *track, double centre[3]);

#endif
