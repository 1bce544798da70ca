/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Remaining time of a run: the cost of an iteration at each resolution of coarse-to-fine, measured or derived from the number of
 * pixels, times the remaining iterations. Only for display: the run does not depend on it.
 */
#ifndef ADCGS_TRAIN_TIME_LEFT_H
#define ADCGS_TRAIN_TIME_LEFT_H

#include "train/schedule.h"

enum { ADCGS_TIME_LEFT_LEVELS = 3 }; /* full, half and quarter size; definition */

typedef struct adcgs_time_left {
    double cost[ADCGS_TIME_LEFT_LEVELS]; /**< recent seconds per iteration at full, half and quarter resolution; 0: unknown */
    double load;                         /**< seconds of the last loading of images */
} adcgs_time_left;

/** Factor of image reduction by coarse-to-fine at a progress: 4, 2 or 1. */
int adcgs_coarse_divide(const adcgs_train_config *config, double progress);
/** Adds the measured time of an iteration at this factor. */
void adcgs_time_left_add(adcgs_time_left *left, int divide, double seconds);
/**
 * Seconds from the start of an iteration to the end of the run or of its time limit, for a run that has taken `elapsed` seconds;
 * NaN while nothing is known.
 */
double adcgs_time_left_of(const adcgs_time_left *left, const adcgs_train_config *config, uint32_t iteration, double elapsed);

#endif
