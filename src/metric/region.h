/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Regions of an image: [height][width], 1 in the region, else 0. A pixel is
 * within reach of another if their distance along both axes is at most reach,
 * which is at most 7. scratch is as large as the region.
 */
#ifndef ADCGS_METRIC_REGION_H
#define ADCGS_METRIC_REGION_H

#include "base/base.h"

/** Set the region to the pixels, inside it or not, for which more than half of all pixels within reach are inside. */
void adcgs_region_majority(uint8_t *region, uint8_t *scratch, int width, int height, int reach);
/** Add all pixels with a pixel of the region within reach. */
void adcgs_region_dilate(uint8_t *region, uint8_t *scratch, int width, int height, int reach);

#endif
