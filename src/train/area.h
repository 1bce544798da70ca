/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Price of size. Large primitives cost every frame that is ever drawn, and few cameras do not keep them from floating
 * where nothing is: what shows as well when it is smaller should be smaller. A term of the training loss alone; a stream
 * knows nothing of it.
 */
#ifndef ADCGS_TRAIN_AREA_H
#define ADCGS_TRAIN_AREA_H

#include "train/raster.h"

/**
 * The price is weight times the mean, over the primitives that there are, of the area (xy + yz + zx) / 3 of their standard
 * deviations x, y, z in scene units. Adds its gradient to scale[3] and returns it.
 */
double adcgs_area_price(const adcgs_primitives *primitives, float weight, float *const scale[3]);

#endif
