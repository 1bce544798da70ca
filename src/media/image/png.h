/* SPDX-License-Identifier: BSD-2-Clause */
/** \file PNG, by libspng, which loads in a fraction of OpenImageIO's time. */
#ifndef ADCGS_MEDIA_IMAGE_PNG_H
#define ADCGS_MEDIA_IMAGE_PNG_H

#include "bits/bytes.h"
#include "media/image/image.h"

#include <stdio.h>

/** The file must be at its start; the caller closes it. path is for messages. */
adcgs_status adcgs_png_probe(FILE *file, int *width, int *height, int *channels, const char *path, adcgs_error *error);
/** An image decoded row by row, in the memory of one row. */
typedef struct adcgs_png_rows adcgs_png_rows;
/** *out is NULL, with the file rewound, if the rows are not stored in order (interlaced). */
adcgs_status adcgs_png_rows_open(adcgs_png_rows **out, FILE *file, int *width, int *height, int *channels, const char *path,
                                 adcgs_error *error);
/** The next row, as adcgs_png_read() returns it. The call for the last row also checks the rest of the file. */
adcgs_status adcgs_png_rows_next(adcgs_png_rows *rows, float *row, const char *path, adcgs_error *error);
void adcgs_png_rows_close(adcgs_png_rows **rows);
/**
 * Reads all kinds of PNG: palettes become RGB, transparent colours become alpha, interlaced rows are put in order. With gAMA of 1
 * and without sRGB, values are linear light and become sRGB. ADCGS_ERR_DATA for a file that ends early and for any wrong
 * checksum.
 */
adcgs_status adcgs_png_read(FILE *file, adcgs_image *out, const char *path, adcgs_error *error);
/** 8 or 16 bits, straight alpha, labelled as sRGB. Appends to out; the caller checks out->failed. */
adcgs_status adcgs_png_encode(adcgs_buffer *out, const adcgs_image *image, const adcgs_image_options *options, const char *path,
                              adcgs_error *error);

#endif
