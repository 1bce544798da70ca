/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Masks: images that mark the pixels of another image that count. Black hides a pixel; if all colours agree, transparency does.
 */
#ifndef ADCGS_SCENE_MASK_H
#define ADCGS_SCENE_MASK_H

#include "media/image/image.h"

/**
 * Replaces an image with alpha by one channel: 1 where a pixel counts, else 0. Black hides a pixel if alpha is the same
 * everywhere. Alpha of 0 hides it if all pixels are black or none is. Both hide it if they agree except for 1 % of the pixels.
 * An image without alpha is unchanged, except that nearly black pixels of a JPEG file become black. ADCGS_ERR_DATA if colours and
 * alpha contradict each other.
 */
adcgs_status adcgs_mask_settle(adcgs_image *mask, const char *path, adcgs_error *error);
/** True if a mask fits an image: both sizes are equal, or both differ, and the aspect ratio is the same to one pixel. */
int adcgs_mask_fits(int width, int height, int image_width, int image_height);
/** Scales a fitting mask to the size of its image; each pixel takes the value of the nearest one. */
adcgs_status adcgs_mask_resize(adcgs_image *mask, int width, int height, const char *path, adcgs_error *error);
/** True if any pixel counts. */
int adcgs_mask_shows(const adcgs_image *mask);

#endif
