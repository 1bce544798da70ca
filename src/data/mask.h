/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images that say which pixels of another count: black hides, and where the colours say nothing, transparent does. */
#ifndef ADCGS_DATA_MASK_H
#define ADCGS_DATA_MASK_H

#include "io/image.h"

/**
 * Of an image with alpha, which is replaced: one channel, 1 where a pixel counts, else 0. Black hides where alpha is the same
 * everywhere, alpha of 0 where all is black or nothing is, and both where they agree but for 1 % of the pixels. An image without
 * alpha stays as it is. ADCGS_ERR_DATA where they contradict each other.
 */
adcgs_status adcgs_mask_settle(adcgs_image *mask, const char *path, adcgs_error *error);

#endif
