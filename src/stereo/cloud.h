/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Points in cells of a grid, so that the nearest of them in place and colour is found quickly, and which way the surface faces
 * there (Hoppe, DeRose, Duchamp, McDonald and Stuetzle 1992, Surface reconstruction from unorganized points, SIGGRAPH).
 */
#ifndef ADCGS_STEREO_CLOUD_H
#define ADCGS_STEREO_CLOUD_H

#include "stereo/rig.h"

/** Where a point is, beside its number: what lies too far away is not looked at further. */
typedef struct adcgs_cloud_place {
    double x[3];
    uint32_t i;
} adcgs_cloud_place;

/** Zero-initialise before use. Points may change their colours and bodies meanwhile, but not go elsewhere. */
typedef struct adcgs_cloud {
    const adcgs_stereo_point *p;
    uint32_t n, used;   /**< of p; of these, those in cells */
    double edge;        /**< of a cell */
    uint32_t mask;      /**< of a cell's number */
    uint32_t *first;    /**< [mask + 2] into at */
    adcgs_cloud_place *at; /**< [used] */
} adcgs_cloud;

/** Every stride'th of points, which the caller keeps. */
adcgs_status adcgs_cloud_init(adcgs_cloud *cloud, const adcgs_stereo_point *points, uint32_t n, uint32_t stride, double edge,
                              adcgs_error *error);
void adcgs_cloud_clear(adcgs_cloud *cloud);

/**
 * The nearest of those that are part of no body to a place and colour, no farther than reach in place. tint: scene units that a
 * unit of colour is worth. \return the squared distance, or a negative number if there is none.
 */
double adcgs_cloud_nearest(const adcgs_cloud *cloud, const double x[3], const float rgb[3], double reach, double tint,
                           uint32_t *found);

/** Those within reach of a place, at most most of them. \return how many. */
uint32_t adcgs_cloud_within(const adcgs_cloud *cloud, const double x[3], double reach, uint32_t *found, uint32_t most);

/** Directions of length 1, away from the surface towards the most views; 0 where too few points are within reach to tell. */
void adcgs_cloud_normals(const adcgs_cloud *cloud, double reach, const adcgs_stereo_rig *rig, float (*normal)[3]);

/** Number the parts that hang together by steps of reach, among points whose mark is 0: part [n], from 1; 0: no part. */
adcgs_status adcgs_cloud_parts(const adcgs_cloud *cloud, double reach, const uint8_t *mark, uint32_t *part, uint32_t *n_parts,
                               adcgs_error *error);

#endif
