/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Densification in time. Where the images of a frame show content that the model lacks, matched points of the frame become
 * anchors with a lifetime around it (lifetimes with a velocity: Wang et al. 2025, FreeTimeGS, CVPR).
 */
#ifndef ADCGS_TRAIN_DENSITY_TEMPORAL_DENSIFY_H
#define ADCGS_TRAIN_DENSITY_TEMPORAL_DENSIFY_H

#include "train/state/state.h"

/**
 * Finds the points with the largest gain in the views of a few frames, which differ between calls. *n: their number, at most
 * `most`.
 */
adcgs_status adcgs_temporal_densify_find(adcgs_trainer *trainer, const adcgs_stereo_point **points, uint32_t most, uint32_t *n,
                                         adcgs_error *error);

#endif
