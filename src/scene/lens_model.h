/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The lens model with its limits, for the files that derive pinholes from lenses. Up to the first fold, the radius in the image
 * grows with the radius of the direction in the world. Directions beyond it are seen twice, or not at all.
 */
#ifndef ADCGS_SCENE_LENS_MODEL_H
#define ADCGS_SCENE_LENS_MODEL_H

#include "scene/lens.h"

/**
 * r^2 of the first fold of the radial part, at most 10^4 (a direction 89.4 degrees from the axis); 0 if the whole model folds.
 */
double adcgs_lens_fold(const adcgs_lens *lens);
/** Like adcgs_lens_project(); returns 0 if the model is folded there. */
int adcgs_lens_see(const adcgs_lens *lens, double fold, double x, double y, double uv[2]);
/** Finds the direction seen at a pixel. Returns 0 if the model has no inverse there. fold: of adcgs_lens_fold(). */
int adcgs_lens_invert(const adcgs_lens *lens, double fold, double u, double v, double xy[2]);

#endif
