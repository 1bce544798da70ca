/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The samples of an image in the fewest bytes that lose nothing: 8 or 16 bits if each sample is a multiple of 1/255 or 1/65535,
 * else binary32. Samples come back equal to the bit.
 */
#ifndef ADCGS_SCENE_PACKED_IMAGE_H
#define ADCGS_SCENE_PACKED_IMAGE_H

#include "base/base.h"

/** Zero: empty. */
typedef struct adcgs_packed_image {
    int width, height, channels; /**< channels 1..4, as in adcgs_image */
    int rows;                    /**< rows put in so far */
    int bytes;                   /**< of a sample: 1, 2, or 4 for binary32 */
    void *data;                  /**< [channels][height][width] */
} adcgs_packed_image;

/** Makes room for an image whose samples have 8 bits; it grows as wider ones come. */
adcgs_status adcgs_packed_image_init(adcgs_packed_image *packed, int width, int height, int channels, const char *path,
                                     adcgs_error *error);
void adcgs_packed_image_clear(adcgs_packed_image *packed);
/** Appends n rows of interleaved samples. path is for messages. */
adcgs_status adcgs_packed_image_append(adcgs_packed_image *packed, const float *from, int n, const char *path,
                                       adcgs_error *error);
/** Takes n rows from row y on, interleaved. */
void adcgs_packed_image_rows(const adcgs_packed_image *packed, int y, int n, float *to);
/** Takes all samples, planar [channels][height][width]. */
void adcgs_packed_image_planes(const adcgs_packed_image *packed, float *to);
/** Bytes of memory. */
size_t adcgs_packed_image_size(const adcgs_packed_image *packed);

#endif
