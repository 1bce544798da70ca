/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Neighbours move together. Each anchor and its nearest ones should move as one rigid body: few pictures show every part at
 * every moment, and what is seen must carry along what is hidden. An energy of the training loss alone; a stream knows
 * nothing of it. Known as an as-rigid-as-possible energy (Sorkine and Alexa 2007, As-rigid-as-possible surface modeling, SGP);
 * between neighbouring Gaussians in Luiten et al. 2024, Dynamic 3D Gaussians, 3DV.
 */
#ifndef ADCGS_FMODEL_RIGIDITY_H
#define ADCGS_FMODEL_RIGIDITY_H

#include "fmodel/pass.h"

/** Neighbours of an anchor: the nearest, then some further ones, which keep whole parts from bending. */
#define ADCGS_RIGIDITY_CLOSE 4
#define ADCGS_RIGIDITY_NEAR 8
#define ADCGS_RIGIDITY_REACH 0.2f /**< scene units: how far the further ones may be */

typedef struct adcgs_rigidity {
    uint32_t n;                           /**< anchors */
    int32_t (*near)[ADCGS_RIGIDITY_NEAR];    /**< [n] nearest other anchors; -1 where there are fewer */
    float *pull;                          /**< [group][12][64]: gradient of the way and of the rotation matrix */
} adcgs_rigidity;

/** (Re)build the neighbourhoods of f's anchors. Zero-initialise *rigid before the first call. */
adcgs_status adcgs_rigidity_build(adcgs_rigidity *rigid, const adcgs_fmodel *f, adcgs_pool *pool, adcgs_error *error);
void adcgs_rigidity_clear(adcgs_rigidity *rigid);

/**
 * Gradient of weight times the mean energy of the pairs into rigid->pull, for the deformation that the pass last computed.
 * An anchor's motion takes x to R x + d. A pair (i, j) costs a robust function of how far apart the motions of i and of j take
 * the place of j, relative to the distance of the two. Returns the mean energy.
 */
double adcgs_rigidity_pull(adcgs_rigidity *rigid, const adcgs_pass *pass, const adcgs_fmodel *f, float weight);

#endif
