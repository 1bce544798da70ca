/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * How well the neighbours of a picture agree with it, pixel by pixel and depth by depth. Depths are planes that face the
 * camera, even in inverse depth, which is even in pixels. Pictures are compared over a small window by normalised
 * correlation, which does not mind how bright a camera is, and by colour, which correlation does not see, and where it is known
 * what moves, by whether it moves in both, which tells the depth of what is thinner than a window; the better half of
 * the neighbours counts, so that what hides a place from some of them does no harm (Kang, Szeliski and Chai 2001, Handling
 * occlusions in dense multi-view stereo, CVPR).
 */
#ifndef ADCGS_STEREO_SWEEP_H
#define ADCGS_STEREO_SWEEP_H

#include "stereo/rig.h"

enum { ADCGS_SWEEP_SOURCES = 8, ADCGS_SWEEP_COST = 200 /**< of no agreement at all */ };

/** A part of a picture, its neighbours, and the planes. */
typedef struct adcgs_sweep {
    const adcgs_stereo_view *view;
    const adcgs_stereo_view *source[ADCGS_SWEEP_SOURCES];
    int n_sources;
    int x, y, w, h;      /**< of the part */
    int planes;
    double first, step;  /**< inverse depth of plane 0, which is the farthest, and from one to the next */
} adcgs_sweep;

/** Planes between two depths, about a pixel apart in the neighbour that sees the most of a difference. */
void adcgs_sweep_set_planes(adcgs_sweep *sweep, double nearest, double farthest);

/** cost: [h][w][planes] 0..ADCGS_SWEEP_COST. */
adcgs_status adcgs_sweep_run(const adcgs_sweep *sweep, int16_t *cost, adcgs_error *error);

#endif
