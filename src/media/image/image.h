/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Image files. PPM and PGM are our own code, PNG goes through libspng, JPEG
 * through libjpeg-turbo, EXR is written by OpenEXRCore. OpenImageIO, in a
 * module, reads TIFF, EXR, WebP, HEIC, AVIF, BMP, GIF, HDR and other netpbm
 * formats, each by its named reader. A build without the encoder has PPM and
 * PGM only. Reading detects formats by content (media/kind.h), writing by
 * extension. An image is encoded in memory, then written as a whole: see
 * atomic.h.
 */
#ifndef ADCGS_MEDIA_IMAGE_IMAGE_H
#define ADCGS_MEDIA_IMAGE_IMAGE_H

#include "base/base.h"

#include <adcgs/types.h>

#define ADCGS_IMAGE_MAX 16384 /**< largest width and height, pixels; definition (the specification's largest camera) */

/**
 * Pixels as binary32, interleaved [height][width][channels], values as stored (8 bit: v/255), in sRGB. Reading converts linear
 * light to sRGB: EXR by default, other formats if the file declares it.
 */
typedef struct adcgs_image {
    int width, height, channels; /**< channels 1..4: grey, grey+alpha, RGB, RGBA (straight alpha) */
    float *data;                 /**< from malloc() */
} adcgs_image;

/**
 * How an image is stored, with additional data. All zero: EXR as binary32, other formats in 8 bit; straight alpha; no additional
 * data.
 */
typedef struct adcgs_image_options {
    const char *format;         /**< extension of the format: "png"; NULL: that of the file name */
    int half;                   /**< EXR: colours and alpha as binary16 */
    int linear;                 /**< EXR: colours in linear light, as other programs expect; else in sRGB */
    int bits;                   /**< not EXR: 8 (or 0), or 16 for PNG, TIFF, PPM and PGM */
    int quality;                /**< JPEG: 1..100, with chroma at half size; 0: 95, with chroma at full size */
    int premultiplied;          /**< the image's colours are already multiplied by its alpha; else they are straight */
    const float *depth;         /**< EXR: channel Z, [height][width], always binary32; NULL: none */
    const adcgs_camera *camera; /**< EXR: camera for the attributes; NULL: none */
    double time;                /**< scene time in seconds; used with a camera */
} adcgs_image_options;

/** Pixels are uninitialised. ADCGS_ERR_DATA, naming path, if a size is outside the limits. */
adcgs_status adcgs_image_alloc(adcgs_image *image, int width, int height, int channels, const char *path, adcgs_error *error);
/** As adcgs_image_alloc(), with the pixels of another image. */
adcgs_status adcgs_image_copy(adcgs_image *copy, const adcgs_image *image, const char *path, adcgs_error *error);
void adcgs_image_free(adcgs_image *image);
/**
 * Limits: 16384 x 16384. Errors have one line and name the file. Non-finite floats and primaries other than sRGB's are errors.
 */
adcgs_status adcgs_image_read(adcgs_image *out, const char *path, adcgs_error *error);
/** An image read from top to bottom, without all of its pixels in memory (PNG that is not interlaced). */
typedef struct adcgs_image_rows adcgs_image_rows;
adcgs_status adcgs_image_rows_open(adcgs_image_rows **out, int *width, int *height, int *channels, const char *path,
                                   adcgs_error *error);
/** Read the next n rows, at most the remaining ones, with the values of adcgs_image_read(). path is for messages. */
adcgs_status adcgs_image_rows_read(adcgs_image_rows *rows, int n, float *to, const char *path, adcgs_error *error);
void adcgs_image_rows_close(adcgs_image_rows **rows);
/** Size and channels without decoding pixels. */
adcgs_status adcgs_image_probe(int *width, int *height, int *channels, const char *path, adcgs_error *error);
/** Format by extension (ppm, exr, png, tif, jpg, ...). Atomic: temporary name, sync, rename. half: EXR stores half floats. */
adcgs_status adcgs_image_write(const adcgs_image *image, const char *path, int half, adcgs_error *error);
/** As adcgs_image_write(), with all options. ADCGS_ERR_USAGE if the format does not support them. */
adcgs_status adcgs_image_write_as(const adcgs_image *image, const adcgs_image_options *options, const char *path,
                                  adcgs_error *error);

/** The decoder's output conversion: floor(clip(v,0,1)*255 + 0.5) in binary32. */
void adcgs_image_to_u8(const float *values, size_t n, uint8_t *out);
/** The same with 65535, in binary64. */
void adcgs_image_to_u16(const float *values, size_t n, uint16_t *out);
/** Multiply colours by alpha, and divide by it (transparent pixels keep their colours). No effect without alpha. */
void adcgs_image_premultiply(adcgs_image *image);
void adcgs_image_unpremultiply(adcgs_image *image);
/** Convert straight colours from linear light to sRGB. The curve continues above 1 and is linear below 0; alpha is unchanged. */
void adcgs_image_to_srgb(adcgs_image *image);
/** The inverse of adcgs_image_to_srgb(). */
void adcgs_image_to_linear(adcgs_image *image);

#endif
