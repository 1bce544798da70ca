/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Points in a hashed grid, for fast nearest-neighbour search in space and colour, and for surface normals (Hoppe, DeRose,
 * Duchamp, McDonald and Stuetzle 1992, Surface reconstruction from unorganized points, SIGGRAPH).
 */
#ifndef ADCGS_INIT_CLOUD_H
#define ADCGS_INIT_CLOUD_H

#include "init/rig.h"

/** Position of a point next to its index, so that distant points are skipped without loading them. */
typedef struct adcgs_cloud_place {
    double x[3];
    uint32_t i;
} adcgs_cloud_place;

/** Zero-initialise before use. The colours and bodies of the points may change later, but not their positions. */
typedef struct adcgs_cloud {
    const adcgs_stereo_point *p;
    uint32_t n, used;      /**< number of points; number of points in the grid */
    double edge;           /**< of a cell, scene units */
    uint32_t mask;         /**< of a cell's hash */
    uint32_t *first;       /**< [mask + 2] indices into at */
    adcgs_cloud_place *at; /**< [used] */
} adcgs_cloud;

/** Builds a grid of every stride'th point. The points must outlive the grid. */
adcgs_status adcgs_cloud_init(adcgs_cloud *cloud, const adcgs_stereo_point *points, uint32_t n, uint32_t stride, double edge,
                              adcgs_error *error);
void adcgs_cloud_clear(adcgs_cloud *cloud);

/**
 * Finds the nearest point in space and colour that belongs to no body, within `reach` in space. tint: scene units per unit of
 * colour difference. \return the squared distance, or a negative number if there is no match.
 */
double adcgs_cloud_nearest(const adcgs_cloud *cloud, const double x[3], const float rgb[3], double reach, double tint,
                           uint32_t *found);

/** Finds points within reach of a position, at most `most` of them. \return their number. */
uint32_t adcgs_cloud_within(const adcgs_cloud *cloud, const double x[3], double reach, uint32_t *found, uint32_t most);

/** Unit normals, oriented towards the cameras on average; 0 where too few points are within reach. */
void adcgs_cloud_normals(const adcgs_cloud *cloud, double reach, const adcgs_stereo_rig *rig, float (*normal)[3]);

/** Labels connected components with links of length reach, among points whose mark is 0. part: [n] label from 1; 0: none. */
adcgs_status adcgs_cloud_parts(const adcgs_cloud *cloud, double reach, const uint8_t *mark, uint32_t *part, uint32_t *n_parts,
                               adcgs_error *error);

#endif
