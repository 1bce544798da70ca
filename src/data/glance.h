/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Pictures at a glance: so few grey cells that those of a whole scene can be kept and compared. */
#ifndef ADCGS_DATA_GLANCE_H
#define ADCGS_DATA_GLANCE_H

#define ADCGS_GLANCE_SIDE 32
#define ADCGS_GLANCE_CELLS (ADCGS_GLANCE_SIDE * ADCGS_GLANCE_SIDE)

typedef struct adcgs_glance {
    float cells[ADCGS_GLANCE_CELLS]; /**< mean grey; not a number where less than half of a cell is known, or where none is */
} adcgs_glance;

/** Of a planar picture [3][height][width], in which pixels that are not known are not numbers, as adcgs_scene_load() gives it. */
void adcgs_glance_take(adcgs_glance *glance, const float *rgb, int width, int height);

/** Mean difference of cells that both know; NaN if there are none. */
double adcgs_glance_difference(const adcgs_glance *a, const adcgs_glance *b);

/**
 * How many times as bright b is as a: the median of the cells' ratios as a logarithm, and in *spread the median of their
 * distances from it. Cells that are nearly black or nearly white in either say nothing. NaN if too few are left.
 */
double adcgs_glance_brighter(const adcgs_glance *a, const adcgs_glance *b, double *spread);

#endif
