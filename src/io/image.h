/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Images in files. PPM and PGM are our own code, PNG goes through libspng, JPEG
 * through libjpeg-turbo, EXR is written by OpenEXRCore; TIFF, EXR, WebP, HEIC,
 * AVIF, BMP, GIF, HDR and other netpbm are read by OpenImageIO, in a module, each
 * by the reader that is named; a build without the encoder has the first only.
 * Reading tells formats by content (io/kind.h), writing by extension. A picture is made in
 * memory, and then written as a whole: see atomic.h.
 */
#ifndef ADCGS_IO_IMAGE_H
#define ADCGS_IO_IMAGE_H

#include "base/base.h"

#include <adcgs/types.h>

#define ADCGS_IMAGE_MAX 16384 /**< largest width and height */

/**
 * Pixels as binary32, interleaved [height][width][channels], values as stored (8 bit: v/255), as sRGB. What a file holds as
 * linear light is converted when it is read: EXR that does not say otherwise, other formats where they say so.
 */
typedef struct adcgs_image {
    int width, height, channels; /**< channels 1..4: grey, grey+alpha, RGB, RGBA (straight alpha) */
    float *data;                 /**< from malloc() */
} adcgs_image;

/** How an image is stored, and what goes with it. All zero: EXR of binary32, else 8 bit; straight alpha; nothing more. */
typedef struct adcgs_image_options {
    const char *format;         /**< what a name of it would end in: "png"; NULL: what the name ends in */
    int half;                   /**< EXR: colours and alpha of binary16 */
    int linear;                 /**< EXR: colours in linear light, as other programs expect of it; else on sRGB's curve */
    int bits;                   /**< not EXR: 8 (or 0), or 16, which PNG, TIFF, PPM and PGM have */
    int premultiplied;          /**< the image's colours are times its alpha already; else they are straight */
    const float *depth;         /**< EXR: channel Z, [height][width], always of binary32; NULL: none */
    const adcgs_camera *camera; /**< EXR: what the attributes say of the camera; NULL: nothing */
    double time;                /**< of the scene, in seconds; with a camera */
} adcgs_image_options;

/** Uninitialised pixels. ADCGS_ERR_DATA, naming path, when a size is not within the limits. */
adcgs_status adcgs_image_alloc(adcgs_image *image, int width, int height, int channels, const char *path, adcgs_error *error);
/** As adcgs_image_alloc(), with the pixels of another. */
adcgs_status adcgs_image_copy(adcgs_image *copy, const adcgs_image *image, const char *path, adcgs_error *error);
void adcgs_image_free(adcgs_image *image);
/** Limits: 16384 x 16384. One-line errors name the file. Floats that are not finite are errors, so are primaries not sRGB's. */
adcgs_status adcgs_image_read(adcgs_image *out, const char *path, adcgs_error *error);
/** An image that is read from top to bottom, without all of its pixels in memory (PNG that is not interlaced). */
typedef struct adcgs_image_rows adcgs_image_rows;
adcgs_status adcgs_image_rows_open(adcgs_image_rows **out, int *width, int *height, int *channels, const char *path,
                                   adcgs_error *error);
/** The next n rows, at most those that are left, with the values of adcgs_image_read(). path is for messages. */
adcgs_status adcgs_image_rows_read(adcgs_image_rows *rows, int n, float *to, const char *path, adcgs_error *error);
void adcgs_image_rows_close(adcgs_image_rows **rows);
/** Size and channels without decoding pixels. */
adcgs_status adcgs_image_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error);
/** Format by extension (ppm, exr, png, tif, jpg, ...). Atomic: temporary name, sync, rename. half: EXR stores half floats. */
adcgs_status adcgs_image_write(const adcgs_image *image, const char *path, int half, adcgs_error *error);
/** As adcgs_image_write(), with all options. ADCGS_ERR_USAGE when the format does not have what they ask for. */
adcgs_status adcgs_image_write_as(const adcgs_image *image, const adcgs_image_options *options, const char *path,
                                  adcgs_error *error);

/** The decoder's output conversion: floor(clip(v,0,1)*255 + 0.5) in binary32. */
void adcgs_image_to_u8(const float *values, size_t n, uint8_t *out);
/** The same with 65535, in binary64. */
void adcgs_image_to_u16(const float *values, size_t n, uint16_t *out);
/** Colours times alpha, and back (transparent pixels keep what they hold). Nothing happens without alpha. */
void adcgs_image_premultiply(adcgs_image *image);
void adcgs_image_unpremultiply(adcgs_image *image);
/** Straight colours from linear light to sRGB's curve, which goes on beyond 1 and straight below 0; alpha stays. */
void adcgs_image_to_srgb(adcgs_image *image);
/** The way back. */
void adcgs_image_to_linear(adcgs_image *image);

#endif
