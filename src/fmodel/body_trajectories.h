/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies: anchors that share a trajectory of rotations and translations, with a pose for each row of the time table (spec
 * clause "Rigid bodies"). A few shared trajectories for all dynamic content are in Wang et al. 2024, Shape of Motion, and Huang
 * et al. 2024, SC-GS, CVPR; here each anchor has one or none.
 */
#ifndef ADCGS_FMODEL_BODY_TRAJECTORIES_H
#define ADCGS_FMODEL_BODY_TRAJECTORIES_H

#include "fmodel/fmodel.h"
#include "grad/dsp.h"

/** Poses from a row of interpolated columns of the time table, starting at f_t. */
void adcgs_bodies_pose(const adcgs_fmodel *f, const float *columns, adcgs_body_place *pose);

/** Gradient with respect to the poses' columns, [7 bodies], from sums over the anchors; columns as above. */
void adcgs_bodies_pose_back(const adcgs_fmodel *f, const float *columns, const adcgs_body_grad *grad, float *d);

/**
 * Sets the pose of a body, counted from 1, in a row of the time table: x maps to R(q) (x - pivot) + pivot + way. q: of length 1;
 * its sign should match the neighbouring rows.
 */
void adcgs_bodies_set_pose(adcgs_fmodel *f, int body, int row, const double q[4], const double pivot[3], const double way[3]);

/**
 * Bounding box in voxels, both ends included, of a body's moving anchors in the first tiers. body: from 1. Returns the number of
 * anchors; 0 for an empty box.
 */
uint32_t adcgs_bodies_box(const adcgs_fmodel *f, int body, int tiers, uint32_t low[3], uint32_t high[3]);

/**
 * Bodies rotate about the centre of the box of their moving anchors, in the first tier that has any, as in the decoder.
 * Recomputes the centres and changes the translations so that all poses are unchanged.
 */
void adcgs_bodies_recentre(adcgs_fmodel *f);

#endif
