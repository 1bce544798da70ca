/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Regions of a picture: [height][width], 1 in the region, else 0. A pixel is within reach of another that is at most so far from
 * it along both axes; reach is 7 at most. scratch is as large as the region.
 */
#ifndef ADCGS_METRIC_REGION_H
#define ADCGS_METRIC_REGION_H

#include "base/base.h"

/** Leave the pixels, in the region or not, of which more than half of all within reach are in it. */
void adcgs_region_majority(uint8_t *region, uint8_t *scratch, int width, int height, int reach);
/** Take in all pixels that have one of the region within reach. */
void adcgs_region_dilate(uint8_t *region, uint8_t *scratch, int width, int height, int reach);

#endif
