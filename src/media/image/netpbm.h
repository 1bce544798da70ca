/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Binary PGM and PPM (P5, P6), 8 and 16 bit. */
#ifndef ADCGS_MEDIA_IMAGE_NETPBM_H
#define ADCGS_MEDIA_IMAGE_NETPBM_H

#include "bits/bytes.h"
#include "media/image/image.h"

#include <stdio.h>

/** The file must be at its start; the caller closes it. path is for messages. */
adcgs_status adcgs_netpbm_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error);
adcgs_status adcgs_netpbm_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error);
/** 8 or 16 bits; alpha is dropped. Appends to out. */
adcgs_status adcgs_netpbm_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options,
                                 const char *path, adcgs_error *error);

#endif
