/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigidity: each anchor and its neighbours should move as one rigid body. Few images show every part in every frame, so visible
 * parts must carry hidden parts along. The energy is part of the training loss only, not of a stream. Known as an
 * as-rigid-as-possible energy (Sorkine and Alexa 2007, As-rigid-as-possible surface modeling, SGP); between neighbouring
 * Gaussians in Luiten et al. 2024, Dynamic 3D Gaussians, 3DV.
 */
#ifndef ADCGS_FMODEL_RIGIDITY_H
#define ADCGS_FMODEL_RIGIDITY_H

#include "fmodel/pass.h"

/* Origin: chosen by hand, not measured. The weight of the energy is measured on synth_robot_dnerf (doc/log/motion.md). */
#define ADCGS_RIGIDITY_CLOSE 4    /**< closest neighbours of an anchor */
#define ADCGS_RIGIDITY_NEAR 8     /**< all neighbours: the closest, and farther ones, which keep whole parts from bending */
#define ADCGS_RIGIDITY_REACH 0.2f /**< scene units: maximum distance of the farther ones */

typedef struct adcgs_rigidity {
    uint32_t n;                           /**< anchors */
    int32_t (*near)[ADCGS_RIGIDITY_NEAR]; /**< [n] other anchors; -1 if there are fewer */
    float *pull;                          /**< [group][12][64]: gradient of the translation and of the rotation matrix */
} adcgs_rigidity;

/** (Re)builds the neighbourhoods of f's anchors. Zero-initialise *rigid before the first call. */
adcgs_status adcgs_rigidity_build(adcgs_rigidity *rigid, const adcgs_fmodel *f, adcgs_pool *pool, adcgs_error *error);
void adcgs_rigidity_clear(adcgs_rigidity *rigid);

/**
 * Sets rigid->pull to the gradient of weight times the mean energy of the pairs, for the last deformation of the pass. An
 * anchor's motion takes x to R x + d. A pair (i, j) costs a robust function of the distance between the positions of j under the
 * motions of i and of j, relative to the distance of i and j. Returns the mean energy.
 */
double adcgs_rigidity_pull(adcgs_rigidity *rigid, const adcgs_pass *pass, const adcgs_fmodel *f, float weight);

#endif
