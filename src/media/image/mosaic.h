/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Images of one size in columns and rows, with white gaps between them. */
#ifndef ADCGS_MEDIA_IMAGE_MOSAIC_H
#define ADCGS_MEDIA_IMAGE_MOSAIC_H

#include "media/image/image.h"

#define ADCGS_MOSAIC_GAP 4 /**< pixels between images; chosen by hand, not measured */
/** Gain of a difference, shown around grey; chosen by hand, not measured. */
#define ADCGS_MOSAIC_GAIN 4.0f

typedef struct adcgs_mosaic {
    int width, height; /**< of a single image */
    int columns, rows;
    adcgs_image image; /**< RGB */
} adcgs_mosaic;

/** RGB samples with any strides: data[pixel * i + channel * c]. */
typedef struct adcgs_samples {
    const float *data;
    size_t pixel, channel;
} adcgs_samples;

/**
 * Allocates the mosaic, all white. ADCGS_ERR_DATA, naming path, if the whole is too large for an image. Call adcgs_mosaic_clear()
 * afterwards.
 */
adcgs_status adcgs_mosaic_init(adcgs_mosaic *mosaic, int width, int height, int columns, int rows, const char *path,
                               adcgs_error *error);
void adcgs_mosaic_clear(adcgs_mosaic *mosaic);
/** Puts an image in its place. */
void adcgs_mosaic_place(adcgs_mosaic *mosaic, int column, int row, adcgs_samples picture);
/** Puts 0.5 + ADCGS_MOSAIC_GAIN (picture - truth) in its place, clipped to 0..1. */
void adcgs_mosaic_difference(adcgs_mosaic *mosaic, int column, int row, adcgs_samples picture, adcgs_samples truth);

#endif
