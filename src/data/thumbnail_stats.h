/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Thumbnails of images, small enough to keep and compare those of a whole scene. */
#ifndef ADCGS_DATA_THUMBNAIL_STATS_H
#define ADCGS_DATA_THUMBNAIL_STATS_H

#define ADCGS_GLANCE_SIDE 32
#define ADCGS_GLANCE_CELLS (ADCGS_GLANCE_SIDE * ADCGS_GLANCE_SIDE)
#define ADCGS_GLANCE_TINT_SIDE (ADCGS_GLANCE_SIDE / 2)
#define ADCGS_GLANCE_TINTS (ADCGS_GLANCE_TINT_SIDE * ADCGS_GLANCE_TINT_SIDE)

/** Kinds of change from one image to another. */
typedef enum adcgs_glance_light { ADCGS_LIGHT_BRIGHTER, ADCGS_LIGHT_REDDER, ADCGS_LIGHT_BLUER, ADCGS_LIGHTS } adcgs_glance_light;

typedef struct adcgs_glance {
    float cells[ADCGS_GLANCE_CELLS]; /**< mean grey; NaN if less than half of the cell is known or it has no pixel */
    /**
     * Logarithms of red over green and of blue over green, in cells of two by two grey cells. NaN if one of these is NaN, or a
     * channel is nearly black or nearly white.
     */
    float tints[2][ADCGS_GLANCE_TINTS];
} adcgs_glance;

/** Computes the thumbnail of a planar image [3][height][width] from adcgs_scene_load(), in which unknown pixels are NaN. */
void adcgs_glance_take(adcgs_glance *glance, const float *rgb, int width, int height);

/** Mean absolute difference of the cells known in both; NaN if there are none. */
double adcgs_glance_difference(const adcgs_glance *a, const adcgs_glance *b);

/**
 * Compares the brightness of b with that of a, or its ratio of red or blue to green. Returns the median of the logarithms of
 * the cells' ratios; *spread is the median of their distances from it. Ignores cells that are nearly black or nearly white in
 * either. NaN if too few cells are left.
 */
double adcgs_glance_compare(const adcgs_glance *a, const adcgs_glance *b, adcgs_glance_light light, double *spread);

/** For each channel, the logarithm of the brightness ratio of b to a: a median, as in adcgs_glance_compare(). NaN likewise. */
void adcgs_glance_gains(const adcgs_glance *a, const adcgs_glance *b, double gains[3]);

#endif
