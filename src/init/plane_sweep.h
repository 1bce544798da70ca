/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Matching costs of an image and its neighbours per pixel and depth. Depths are planes that face the camera, evenly spaced in
 * inverse depth and so in pixels. Small windows are compared by normalised correlation, which ignores the brightness of a camera,
 * and by colour, which correlation ignores. Where motion is known, the cost also compares if both show moving content, which
 * gives the depth of objects thinner than a window. Only the better half of the neighbours counts, so that occlusion in some of
 * them does no harm (Kang, Szeliski and Chai 2001, Handling occlusions in dense multi-view stereo, CVPR).
 */
#ifndef ADCGS_INIT_PLANE_SWEEP_H
#define ADCGS_INIT_PLANE_SWEEP_H

#include "init/rig.h"

/** Maximum number of neighbours of a view, and the maximum cost; chosen by hand, not measured. */
enum { ADCGS_SWEEP_SOURCES = 8, ADCGS_SWEEP_COST = 200 };

/** A part of an image, its neighbours, and the planes. */
typedef struct adcgs_sweep {
    const adcgs_stereo_view *view;
    const adcgs_stereo_view *source[ADCGS_SWEEP_SOURCES];
    int n_sources;
    int x, y, w, h; /**< of the part */
    int planes;
    double first, step; /**< inverse depth of plane 0, the farthest, and step to the next plane */
} adcgs_sweep;

/** Sets planes between two depths, about one pixel apart in the neighbour with the largest disparity. */
void adcgs_sweep_set_planes(adcgs_sweep *sweep, double nearest, double farthest);

/** cost: [h][w][planes] 0..ADCGS_SWEEP_COST. */
adcgs_status adcgs_sweep_run(const adcgs_sweep *sweep, int16_t *cost, adcgs_error *error);

#endif
