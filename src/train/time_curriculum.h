/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Curriculum over time. A run starts with the views around the middle of time and gradually adds others. A new row of the time
 * table starts as a copy of its neighbour. So motion is tracked from one time to the next instead of being sought at all times at
 * once. See Bengio et al. 2009, Curriculum learning, ICML. A run that continues the previous segment starts at the beginning of
 * time, where that segment ended, and bodies continue their motion.
 */
#ifndef ADCGS_TRAIN_TIME_CURRICULUM_H
#define ADCGS_TRAIN_TIME_CURRICULUM_H

#include "fmodel/fmodel.h"
#include "train/state/visit.h"

typedef struct adcgs_curriculum_view {
    float t;        /* in [0,1] */
    uint32_t index; /* of the view */
} adcgs_curriculum_view;

typedef struct adcgs_curriculum {
    adcgs_curriculum_view *views; /* [n_views] by distance from the start of the curriculum */
    int forward;                  /* 1: from the beginning of time, not from its middle */
    uint16_t known;               /* bit b: the poses of body b + 1 are known */
    uint32_t n_views;
    uint32_t n;          /* views in training; 0: not started */
    int32_t first, last; /* range of time table rows in training */
} adcgs_curriculum;

/** t: time of each view, as a fraction of the scene's duration. */
adcgs_status adcgs_curriculum_create(adcgs_curriculum *window, const float *t, uint32_t n_views, int forward, adcgs_error *error);
void adcgs_curriculum_clear(adcgs_curriculum *window);
/** Stores or restores the reach of the window. */
void adcgs_curriculum_walk(adcgs_checkpoint_walk *walk, adcgs_curriculum *window);
/** Extends the training to this fraction of the views. New rows of the time table are copied from their neighbours. */
void adcgs_curriculum_grow(adcgs_curriculum *window, double fraction, adcgs_fmodel *f);
/** Picks a view of the window for the given view pass; every second time one of the latest quarter. */
uint32_t adcgs_curriculum_pick(const adcgs_curriculum *window, uint64_t seed, uint32_t look);

#endif
