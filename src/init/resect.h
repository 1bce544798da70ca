/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Camera pose from 3D-2D correspondences with outliers: least squares of the reprojection errors with robust weights, started
 * from poses that two correspondences give (Fischler and Bolles 1981, Random sample consensus, CACM 24).
 */
#ifndef ADCGS_INIT_RESECT_H
#define ADCGS_INIT_RESECT_H

#include "init/correspondence.h"

/** Reprojection error in pixels; infinite if the point is behind the camera. */
double adcgs_reprojection_error(const adcgs_stereo_view *view, const adcgs_correspondence *match);

/** Number of correspondences with an error of less than `off` pixels. */
int adcgs_correspondences_count_inliers(const adcgs_stereo_view *view, const adcgs_correspondences *matches, double off);

/** Moves a view to the pose of least squares; its image is not used. off: expected initial error in pixels. */
void adcgs_resect(adcgs_stereo_view *view, const adcgs_correspondences *matches, double off);

/**
 * The same without an initial pose. views: the other cameras, indexed by the correspondences' `from`. The camera may be at its
 * given position or at the position of another camera. Random choices are seeded with `seed`.
 */
void adcgs_resect_anywhere(adcgs_stereo_view *view, const adcgs_correspondences *matches, const adcgs_stereo_view *views,
                           uint64_t seed);

#endif
