/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * How long a run still takes: what an iteration costs at each of the resolutions of coarse-to-fine, as measured or as follows
 * from their pixels, times the iterations that are still to come at each. Only for showing: nothing of a run depends on it.
 */
#ifndef ADCGS_TRAIN_TIME_LEFT_H
#define ADCGS_TRAIN_TIME_LEFT_H

#include "train/schedule.h"

enum { ADCGS_TIME_LEFT_LEVELS = 3 };

typedef struct adcgs_time_left {
    double cost[ADCGS_TIME_LEFT_LEVELS]; /**< seconds of an iteration lately, at full, half, quarter resolution; 0: not known */
    double load;                         /**< seconds that loading the pictures took the last time */
} adcgs_time_left;

/** The factor by which coarse-to-fine divides pictures at a progress: 4, 2 or 1. */
int adcgs_coarse_divide(const adcgs_train_config *config, double progress);
/** An iteration at such a factor took so long. */
void adcgs_time_left_add(adcgs_time_left *left, int divide, double seconds);
/**
 * Seconds from the beginning of an iteration, of a run that has taken `elapsed`, to the end of the run or of its time limit; not
 * a number as long as nothing is known.
 */
double adcgs_time_left_of(const adcgs_time_left *left, const adcgs_train_config *config, uint32_t iteration, double elapsed);

#endif
