/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Even thinning of points: one per grid cell. Cells grow with the size of a pixel and shrink with detail. */
#ifndef ADCGS_INIT_THIN_H
#define ADCGS_INIT_THIN_H

#include "init/fuse.h"

/** Leaves at most `most` points, ordered by cell, and not many fewer if the list is longer. */
adcgs_status adcgs_stereo_thin(adcgs_stereo_list *list, uint32_t most, adcgs_error *error);

#endif
