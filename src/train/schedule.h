/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Schedule of a run: its stages, and the learning rates. After a constant phase, rates decay exponentially from the first value
 * to the last (Adam: Kingma and Ba 2015, ICLR; rates of splats: Kerbl et al. 2023, 3D Gaussian splatting, SIGGRAPH).
 */
#ifndef ADCGS_TRAIN_SCHEDULE_H
#define ADCGS_TRAIN_SCHEDULE_H

#include "train/train_config.h"

/** Sets the learning rates of a new model's parameter groups: the defaults times the configured factors. */
void adcgs_train_rates(const adcgs_train_config *config, adcgs_fmodel *f);

/** Learning rate at a progress in [0,1], from its first and last values. */
float adcgs_train_rate(const adcgs_train_config *config, float first, float last, double progress);

/** Minimum iterations before pruning of hidden units; networks are not trained enough before; chosen by hand, not measured. */
enum { ADCGS_UNITS_AFTER = 1000 };
/** True if hidden units are pruned at all. */
int adcgs_train_prunes_units(const adcgs_train_config *config);
/** Progress from which lambda affects the run; greater than 1: never. */
double adcgs_train_lambda_from(const adcgs_train_config *config);

/** Name of the last of the main stages that has begun at a progress in [0,1], for display and log; see stage_table.h. */
const char *adcgs_train_stage(const adcgs_train_config *config, double progress);

#endif
