/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Fewer points, evenly: one for each cell of space, of cells that grow with the size of a pixel and shrink with detail. */
#ifndef ADCGS_STEREO_THIN_H
#define ADCGS_STEREO_THIN_H

#include "stereo/fuse.h"

/** Leave at most `most` points, and not many fewer if there are more; in the order of their cells. */
adcgs_status adcgs_stereo_thin(adcgs_stereo_list *list, uint32_t most, adcgs_error *error);

#endif
