/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Which settled anchors learn again, in a run that goes on with the segment before: those whose part of the picture has become
 * another, in brightness or because what moves is not followed there. Who learns is sent anew.
 */
#ifndef ADCGS_TRAIN_RELEASE_H
#define ADCGS_TRAIN_RELEASE_H

#include "train/state.h"

/**
 * Release them, at the moments of a run when that is asked. Where there is nothing to learn at all, the run is at its end: its
 * iteration is the last.
 */
adcgs_status adcgs_release_step(adcgs_trainer *trainer, double progress, adcgs_error *error);

#endif
