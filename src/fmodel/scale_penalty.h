/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Price of size. Large primitives cost every frame that is ever drawn, and few cameras do not keep them from floating
 * where nothing is, least of all before their own eyes: what shows as well when it is smaller should be smaller. A term of the
 * training loss alone; a stream knows nothing of it. Prices of volume are in Lombardi et al. 2021, Mixture of volumetric
 * primitives, SIGGRAPH, and Lu et al. 2024, Scaffold-GS, CVPR.
 */
#ifndef ADCGS_FMODEL_SCALE_PENALTY_H
#define ADCGS_FMODEL_SCALE_PENALTY_H

#include "grad/raster.h"

/** Where a scene is likely to be seen from. Zero-initialise before use. */
typedef struct adcgs_viewpoints {
    uint32_t n;
    float (*x)[3]; /**< scene units */
} adcgs_viewpoints;

/** The cameras (equal ones once), and half-way from each to the two that are nearest. */
adcgs_status adcgs_viewpoints_create(adcgs_viewpoints *viewpoints, const float (*camera)[3], uint32_t n_cameras,
                                     adcgs_error *error);
void adcgs_viewpoints_clear(adcgs_viewpoints *viewpoints);

/**
 * The price is weight times the mean, over the primitives that there are, of the area (xy + yz + zx) / 3 of their standard
 * deviations x, y, z in scene units, as large as it looks from the nearest viewpoint: over the square of the distance. Without
 * viewpoints all are at distance 1. Adds its gradient by the scales to scale[3] and returns it.
 */
double adcgs_scale_penalty(const adcgs_primitives *primitives, const adcgs_viewpoints *viewpoints, float weight,
                        float *const scale[3]);

#endif
