/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Images in files. Reading goes through OpenImageIO (and our own PPM reader);
 * writing through one small table of formats: PPM, PFM-free raw, Y4M (own code), EXR
 * (OpenEXRCore), everything else OpenImageIO.
 */
#ifndef ADCGS_IO_IMAGE_H
#define ADCGS_IO_IMAGE_H

#include "base/base.h"

/** Pixels as binary32, interleaved [height][width][channels], values as stored (8 bit: v/255), no colour conversion. */
typedef struct adcgs_image {
    int width, height, channels; /**< channels 1..4: grey, grey+alpha, RGB, RGBA (straight alpha) */
    float *data;
} adcgs_image;

void adcgs_image_free(adcgs_image *image);
/** Limits: 16384 x 16384. One-line errors name the file. */
adcgs_status adcgs_image_read(adcgs_image *out, const char *path, adcgs_error *error);
/** Size and channels without decoding pixels. */
adcgs_status adcgs_image_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error);
/** Format by extension (ppm, exr, png, tif, jpg, ...). Atomic: temporary name, sync, rename. half: EXR stores half floats. */
adcgs_status adcgs_image_write(const adcgs_image *image, const char *path, int half, adcgs_error *error);

#endif
