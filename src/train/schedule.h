/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * What a configuration says about moments of a run: its stages, and the learning rates, which from a moment on fall
 * exponentially from the first value to the last (Adam: Kingma and Ba 2015, ICLR; rates of splats: Kerbl et al. 2023, 3D
 * Gaussian splatting, SIGGRAPH).
 */
#ifndef ADCGS_TRAIN_SCHEDULE_H
#define ADCGS_TRAIN_SCHEDULE_H

#include "train/config.h"

/** Learning rates of a fresh model's parameter groups: what suits each, times what the configuration says of its kind. */
void adcgs_train_rates(const adcgs_train_config *config, adcgs_fmodel *f);

/** A learning rate at a progress in [0,1], of what it is at first and at last. */
float adcgs_train_rate(const adcgs_train_config *config, float first, float last, double progress);

/** Before that many iterations networks have not had their chance, and hidden units stay. */
enum { ADCGS_UNITS_AFTER = 1000 };
/** Whether hidden units that do not pay go at all. */
int adcgs_train_prunes_units(const adcgs_train_config *config);
/** The moment from which lambda has a say; more than 1 if it never has. */
float adcgs_train_lambda_from(const adcgs_train_config *config);

/** Stage of a run at a progress in [0,1], for display and log. */
const char *adcgs_train_stage(const adcgs_train_config *config, double progress);

#endif
