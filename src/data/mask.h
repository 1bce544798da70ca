/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Masks: images that mark the pixels of another image that count. Black hides a pixel; if all colours agree, transparency does.
 */
#ifndef ADCGS_DATA_MASK_H
#define ADCGS_DATA_MASK_H

#include "io/image.h"

/**
 * Replaces an image with alpha by one channel: 1 where a pixel counts, else 0. Black hides a pixel if alpha is the same
 * everywhere. Alpha of 0 hides it if all pixels are black or none is. Both hide it if they agree except for 1 % of the pixels.
 * An image without alpha is unchanged. ADCGS_ERR_DATA if colours and alpha contradict each other.
 */
adcgs_status adcgs_mask_settle(adcgs_image *mask, const char *path, adcgs_error *error);

#endif
