/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies: anchors that share a trajectory of rotations and ways, a pose for each row of the time table (spec clause "Rigid
 * bodies"). A few shared trajectories for all that moves are in Wang et al. 2024, Shape of Motion, and Huang et al. 2024, SC-GS,
 * CVPR; here each anchor has one or none.
 */
#ifndef ADCGS_FMODEL_BODIES_H
#define ADCGS_FMODEL_BODIES_H

#include "fmodel/fmodel.h"
#include "grad/dsp.h"

/** Poses at a row of interpolated columns of the time table, from f_t on. */
void adcgs_bodies_pose(const adcgs_fmodel *f, const float *columns, adcgs_body_place *pose);

/** From sums over the anchors to the gradient by the poses' columns, [7 bodies]; columns as above. */
void adcgs_bodies_pose_back(const adcgs_fmodel *f, const float *columns, const adcgs_body_grad *grad, float *d);

/**
 * Set the pose of a body, from 1, in a row of the time table: x goes to R(q) (x - pivot) + pivot + way. q of length 1; its sign
 * should be that of the neighbouring rows.
 */
void adcgs_bodies_set_pose(adcgs_fmodel *f, int body, int row, const double q[4], const double pivot[3], const double way[3]);

/**
 * The box of a body's anchors that move, from 1, of the first tiers, in voxels, both ends in it. Returns how many there are; of
 * none it is empty.
 */
uint32_t adcgs_bodies_box(const adcgs_fmodel *f, int body, int tiers, uint32_t low[3], uint32_t high[3]);

/**
 * Bodies turn about the middle of the box of their anchors that move, in the first tier that has any, as a decoder finds it:
 * find it again, and change the ways so that all poses stay as they are.
 */
void adcgs_bodies_recentre(adcgs_fmodel *f);

#endif
