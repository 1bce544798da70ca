/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Distances between anchors. */
#ifndef ADCGS_TRAIN_DENSITY_SPACING_H
#define ADCGS_TRAIN_DENSITY_SPACING_H

#include <adcgs/types.h>

/**
 * Mean distance of each voxel to its three nearest voxels, or to all if there are fewer, in voxels; 0 for a single voxel. pos
 * [n][3]: in Morton order, all different, coordinates below 2^21. mean: [n].
 */
adcgs_status adcgs_spacings(const uint32_t (*pos)[3], uint32_t n, double *mean, adcgs_error *error);

#endif
