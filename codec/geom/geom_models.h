/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Internals of the position coder: coding the split of one cell, given its
 * neighbours. geom.c walks the cells, models.c codes their counts.
 */
#ifndef ADCGS_GEOM_MODELS_H
#define ADCGS_GEOM_MODELS_H

#include "bits/range.h"
#include "geom/geom.h"

#define ADCGS_GEOM_STEPS_MAX (3 * ADCGS_GEOM_DEPTH_MAX)
#define ADCGS_GEOM_COUNT_CLASSES 13 /* min(n, 12) */

/** Information from the cells around a cell when its count is split. */
typedef struct adcgs_geom_around {
    uint32_t before, behind;           /**< counts of the two cells next to it along the axis */
    uint64_t ring_before, ring_behind; /**< sums over the eight cells around each of those */
    int lateral_left, lateral_right;   /**< numbers of lateral neighbours already split that have points left, right; 0..4 */
} adcgs_geom_around;

/** All contexts of the coder. */
typedef struct adcgs_geom_models {
    struct {
        adcgs_adaptive signs[27], lateral[25 * 9], step[ADCGS_GEOM_STEPS_MAX * 9];
    } side[2]; /* of a single point; of several points */
    adcgs_adaptive one_step[ADCGS_GEOM_STEPS_MAX * ADCGS_GEOM_COUNT_CLASSES];
    adcgs_adaptive one_lateral[16 * ADCGS_GEOM_COUNT_CLASSES], one_axis[27 * ADCGS_GEOM_COUNT_CLASSES];
    adcgs_adaptive few[2][16][16], many[32][16];
} adcgs_geom_models;

/** The direction of the coder: exactly one of the two is set. */
typedef struct adcgs_geom_coder {
    adcgs_range_enc *enc;
    adcgs_range_dec *dec;
    adcgs_geom_models *models;
} adcgs_geom_coder;

void adcgs_geom_models_init(adcgs_geom_models *models);
/**
 * Code how many of n points of a cell go left (left: that number, when encoding). Each half holds at most capacity points, and
 * n <= 2 * capacity. around is all zero for a point without neighbours.
 */
uint32_t adcgs_geom_code_split(adcgs_geom_coder *c, int step, uint32_t n, uint64_t capacity, const adcgs_geom_around *around,
                               uint32_t left);

#endif
