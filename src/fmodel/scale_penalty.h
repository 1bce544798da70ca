/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Scale penalty. Large primitives cost time in every rendered frame. With few cameras they also float in empty space, above all
 * in front of the cameras. So a primitive should be small if the image allows it. The penalty is part of the training loss only,
 * not of a stream. Volume penalties are in Lombardi et al. 2021, Mixture of volumetric primitives, SIGGRAPH, and Lu et al. 2024,
 * Scaffold-GS, CVPR.
 */
#ifndef ADCGS_FMODEL_SCALE_PENALTY_H
#define ADCGS_FMODEL_SCALE_PENALTY_H

#include "grad/raster.h"

/** Likely viewpoints of a scene. Zero-initialise before use. */
typedef struct adcgs_viewpoints {
    uint32_t n;
    float (*x)[3]; /**< scene units */
} adcgs_viewpoints;

/** The cameras (duplicates once), and the midpoints between each camera and its two nearest others. */
adcgs_status adcgs_viewpoints_create(adcgs_viewpoints *viewpoints, const float (*camera)[3], uint32_t n_cameras,
                                     adcgs_error *error);
void adcgs_viewpoints_clear(adcgs_viewpoints *viewpoints);

/**
 * Penalty: weight times the mean area (xy + yz + zx) / 3 of the primitives' standard deviations x, y, z in scene units, divided
 * by the squared distance from the nearest viewpoint. Without viewpoints the distance is 1. Transparent primitives do not count.
 * Adds its gradient with respect to the scales to scale[3], and returns the penalty.
 */
double adcgs_scale_penalty(const adcgs_primitives *primitives, const adcgs_viewpoints *viewpoints, float weight,
                           float *const scale[3]);

#endif
