/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures at a glance: so few cells that those of a whole scene can be kept and compared. */
#ifndef ADCGS_DATA_GLANCE_H
#define ADCGS_DATA_GLANCE_H

#define ADCGS_GLANCE_SIDE 32
#define ADCGS_GLANCE_CELLS (ADCGS_GLANCE_SIDE * ADCGS_GLANCE_SIDE)
#define ADCGS_GLANCE_TINT_SIDE (ADCGS_GLANCE_SIDE / 2)
#define ADCGS_GLANCE_TINTS (ADCGS_GLANCE_TINT_SIDE * ADCGS_GLANCE_TINT_SIDE)

/** What pictures become from one to the next. */
typedef enum adcgs_glance_light { ADCGS_LIGHT_BRIGHTER, ADCGS_LIGHT_REDDER, ADCGS_LIGHT_BLUER, ADCGS_LIGHTS } adcgs_glance_light;

typedef struct adcgs_glance {
    float cells[ADCGS_GLANCE_CELLS]; /**< mean grey; not a number where less than half of a cell is known, or where none is */
    /**
     * Logarithms of red and of blue over green, in cells of two by two of these; not numbers where one of these is none, or a
     * channel is nearly black or nearly white.
     */
    float tints[2][ADCGS_GLANCE_TINTS];
} adcgs_glance;

/** Of a planar picture [3][height][width], in which pixels that are not known are not numbers, as adcgs_scene_load() gives it. */
void adcgs_glance_take(adcgs_glance *glance, const float *rgb, int width, int height);

/** Mean difference of cells that both know; NaN if there are none. */
double adcgs_glance_difference(const adcgs_glance *a, const adcgs_glance *b);

/**
 * How many times as bright b is as a, or as red or blue beside green: the median of the cells' ratios as a logarithm, and in
 * *spread the median of their distances from it. Cells that are nearly black or nearly white in either say nothing. NaN if too
 * few are left.
 */
double adcgs_glance_compare(const adcgs_glance *a, const adcgs_glance *b, adcgs_glance_light light, double *spread);

/** How many times as bright each channel of b is as that of a: as adcgs_glance_compare(), medians as logarithms. NaN likewise. */
void adcgs_glance_gains(const adcgs_glance *a, const adcgs_glance *b, double gains[3]);

#endif
