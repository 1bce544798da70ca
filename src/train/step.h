/* SPDX-License-Identifier: BSD-2-Clause */
/** \file One iteration: its view passes, and an Adam step (Kingma and Ba, 2015) with the mean of their gradients. */
#ifndef ADCGS_TRAIN_STEP_H
#define ADCGS_TRAIN_STEP_H

#include "train/state/state.h"

adcgs_status adcgs_train_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
