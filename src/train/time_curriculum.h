/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The part of time that is trained on. A run begins with the views about the middle of time and takes in others as it goes on:
 * a row of the time table begins where its neighbour stands, so that what moves is followed from one time to the next instead
 * of being sought at all times at once. A curriculum (Bengio et al. 2009, Curriculum learning, ICML) over time. A run that goes
 * on with the segment before begins at the beginning, where that ended, and bodies go on as they went.
 */
#ifndef ADCGS_TRAIN_TIME_CURRICULUM_H
#define ADCGS_TRAIN_TIME_CURRICULUM_H

#include "fmodel/fmodel.h"

typedef struct adcgs_curriculum_view {
    float t;        /* in [0,1] */
    uint32_t index; /* of the view */
} adcgs_curriculum_view;

typedef struct adcgs_curriculum {
    adcgs_curriculum_view *views; /* [n_views] by their distance from where it begins */
    int forward;              /* from the beginning of time, not from its middle */
    uint16_t known;           /* bit b: body b + 1 has its poses already */
    uint32_t n_views;
    uint32_t n;               /* how many of them are trained on; 0: not begun */
    int32_t first, last;      /* rows of the time table that these have reached */
} adcgs_curriculum;

/** t: time of each view, as a fraction of the scene's. */
adcgs_status adcgs_curriculum_create(adcgs_curriculum *window, const float *t, uint32_t n_views, int forward,
                                     adcgs_error *error);
void adcgs_curriculum_clear(adcgs_curriculum *window);
/** Take in the views of this fraction of all; rows of the time table newly reached become copies of their neighbours. */
void adcgs_curriculum_grow(adcgs_curriculum *window, double fraction, adcgs_fmodel *f);
/** A view of the window, of which so many have been looked at; every other time one of those taken in last. */
uint32_t adcgs_curriculum_pick(const adcgs_curriculum *window, uint64_t seed, uint32_t look);

#endif
