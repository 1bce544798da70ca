/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Following one rigid body from the moment at which it is found to all others: where it should be if it goes on as before, and
 * turned in all ways about that; of the starts that fit best the one is taken whose pictures agree. Its points are those of all
 * moments, so that sides that come into sight become part of it, and what does not go along is dropped.
 */
#ifndef ADCGS_STEREO_TRACK_H
#define ADCGS_STEREO_TRACK_H

#include "stereo/layers.h"

/** A body and where it is. Zero-initialise before use. */
typedef struct adcgs_track {
    adcgs_body_model model;
    adcgs_placing place[ADCGS_STEREO_MOMENTS];
    uint8_t known[ADCGS_STEREO_MOMENTS];
} adcgs_track;

/** Follow model, which is at rest at a moment, to all others. */
adcgs_status adcgs_track_run(adcgs_track *track, const adcgs_layers *layers, int start, adcgs_pool *pool, adcgs_error *error);

/** Where a body was lost, or leapt, see whether it went on as before. */
void adcgs_track_look_again(adcgs_track *track, const adcgs_layers *layers, int start);

/** Refine all moments against all of the body. */
void adcgs_track_refine(adcgs_track *track, const adcgs_layers *layers, adcgs_pool *pool);

/** How far two places put a body's points apart, in the mean. */
double adcgs_track_between(const adcgs_track *track, const adcgs_rigid *a, const adcgs_rigid *b);

/** Where it is if it goes on as between two moments, of which the first is the nearer one. */
void adcgs_track_go_on(const adcgs_track *track, const adcgs_layers *layers, int moment, const int known[2], adcgs_rigid *out);

/** Where a body at rest is in the middle of its points, and how far these are from there. */
double adcgs_track_centre(const adcgs_track *track, double centre[3]);

#endif
