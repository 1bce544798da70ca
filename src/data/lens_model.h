/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The lens's model with its limits, for the files that make pinholes of lenses. The radius of a direction in the picture
 * grows with its radius in the world up to the first fold; what is seen beyond that is seen twice, or not at all.
 */
#ifndef ADCGS_DATA_LENS_MODEL_H
#define ADCGS_DATA_LENS_MODEL_H

#include "data/lens.h"

/** r^2 of the first fold of the radial part, at most 10^4 (a direction 89.4 degrees from the axis); 0 if all is folded. */
double adcgs_lens_fold(const adcgs_lens *lens);
/** As adcgs_lens_project(); 0 where the model is folded. */
int adcgs_lens_see(const adcgs_lens *lens, double fold, double x, double y, double uv[2]);
/** As adcgs_lens_unproject(). */
int adcgs_lens_invert(const adcgs_lens *lens, double fold, double u, double v, double xy[2]);

#endif
