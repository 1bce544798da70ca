/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Thumbnails of images, small enough to keep and compare those of a whole scene. */
#ifndef ADCGS_SCENE_THUMBNAIL_STATS_H
#define ADCGS_SCENE_THUMBNAIL_STATS_H

#define ADCGS_THUMBNAIL_SIDE 32 /* cells along a side; chosen by hand, not measured */
#define ADCGS_THUMBNAIL_CELLS (ADCGS_THUMBNAIL_SIDE * ADCGS_THUMBNAIL_SIDE)
#define ADCGS_THUMBNAIL_TINT_SIDE (ADCGS_THUMBNAIL_SIDE / 2) /* the same for colours: of four cells the mean */
#define ADCGS_THUMBNAIL_TINTS (ADCGS_THUMBNAIL_TINT_SIDE * ADCGS_THUMBNAIL_TINT_SIDE)

/** Kinds of change from one image to another. */
typedef enum adcgs_thumbnail_light {
    ADCGS_LIGHT_BRIGHTER,
    ADCGS_LIGHT_REDDER,
    ADCGS_LIGHT_BLUER,
    ADCGS_LIGHTS
} adcgs_thumbnail_light;

typedef struct adcgs_thumbnail {
    float cells[ADCGS_THUMBNAIL_CELLS]; /**< mean grey; NaN if less than half of the cell is known or it has no pixel */
    /**
     * Logarithms of red over green and of blue over green, in cells of two by two grey cells. NaN if one of these is NaN, or a
     * channel is nearly black or nearly white.
     */
    float tints[2][ADCGS_THUMBNAIL_TINTS];
} adcgs_thumbnail;

/** Computes the thumbnail of a planar image [3][height][width] from adcgs_scene_image(), in which unknown pixels are NaN. */
void adcgs_thumbnail_compute(adcgs_thumbnail *thumbnail, const float *rgb, int width, int height);

/** Mean absolute difference of the cells known in both; NaN if there are none. */
double adcgs_thumbnail_difference(const adcgs_thumbnail *a, const adcgs_thumbnail *b);

/**
 * Compares the brightness of b with that of a, or its ratio of red or blue to green. Returns the median of the logarithms of
 * the cells' ratios; *spread is the median of their distances from it. Ignores cells that are nearly black or nearly white in
 * either. NaN if too few cells are left.
 */
double adcgs_thumbnail_compare(const adcgs_thumbnail *a, const adcgs_thumbnail *b, adcgs_thumbnail_light light, double *spread);

/** For each channel, the logarithm of the brightness ratio of b to a: a median, as in adcgs_thumbnail_compare(). NaN likewise. */
void adcgs_thumbnail_gains(const adcgs_thumbnail *a, const adcgs_thumbnail *b, double gains[3]);

#endif
