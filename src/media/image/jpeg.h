/* SPDX-License-Identifier: BSD-2-Clause */
/** \file JPEG, by libjpeg-turbo. */
#ifndef ADCGS_MEDIA_IMAGE_JPEG_H
#define ADCGS_MEDIA_IMAGE_JPEG_H

#include "bits/bytes.h"
#include "media/image/image.h"

#include <stdio.h>

/** The file must be at its start; the caller closes it. path is for messages. */
adcgs_status adcgs_jpeg_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error);
/**
 * Reads grey or RGB; other colours are converted to RGB. ADCGS_ERR_DATA for a file that ends early, which the library would fill
 * up with grey, and for damaged coded data.
 */
adcgs_status adcgs_jpeg_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error);
/**
 * By default with quality 95 and chroma at full size. Appends to out. ADCGS_ERR_USAGE for alpha and for 16 bits, which JPEG does
 * not support.
 */
adcgs_status adcgs_jpeg_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                               adcgs_error *error);

#endif
