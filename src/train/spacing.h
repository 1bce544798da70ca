/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How far apart anchors are. */
#ifndef ADCGS_TRAIN_SPACING_H
#define ADCGS_TRAIN_SPACING_H

#include <adcgs/types.h>

/**
 * Mean distance of each voxel to its three nearest others, or to as many as there are, in voxels; 0 for one that is alone.
 * pos [n][3]: in Morton order, no two alike, coordinates below 2^21. mean: [n].
 */
adcgs_status adcgs_spacings(const uint32_t (*pos)[3], uint32_t n, double *mean, adcgs_error *error);

#endif
