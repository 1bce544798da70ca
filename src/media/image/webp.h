/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Lossless WebP as bytes that formats of splats store their numbers in. Photographs are read by media/image/photo.h. Red, green
 * and blue under a low alpha are kept.
 */
#ifndef ADCGS_MEDIA_IMAGE_WEBP_H
#define ADCGS_MEDIA_IMAGE_WEBP_H

#include "base/base.h"

typedef struct adcgs_webp {
    int width, height;
    uint8_t *pixels; /**< RGBA, row by row; from malloc() */
} adcgs_webp;

/**
 * Read an image in memory. ADCGS_ERR_DATA, naming path and name, for other data, an image that is damaged or lossy, and one of
 * more than `most` pixels, before memory is allocated. ADCGS_ERR_UNSUPPORTED in a build without libwebp. On failure *out is
 * empty.
 */
adcgs_status adcgs_webp_parse(adcgs_webp *out, const uint8_t *data, size_t bytes, uint64_t most, const char *path,
                              const char *name, adcgs_error *error);
void adcgs_webp_clear(adcgs_webp *image);

#endif
