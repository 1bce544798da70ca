/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies of a run that continues the previous segment. Matching tracks bodies from the first frame of the segment without
 * knowledge of the model's bodies. They are matched by position at that time, and their poses are composed with the state at the
 * end of the previous segment.
 */
#ifndef ADCGS_TRAIN_CONTINUE_BODIES_H
#define ADCGS_TRAIN_CONTINUE_BODIES_H

#include "fmodel/fmodel.h"
#include "init/stereo.h"

/**
 * Gives found bodies the numbers of the model's bodies. The model's time table starts at the end of the previous segment. The
 * poses then map the model's rest positions to the scene. A new body gets a free number, or none if no number is free. Afterwards
 * found->body[b - 1] is body b, with no poses if it was not found.
 */
adcgs_status adcgs_continue_bodies(const adcgs_fmodel *f, adcgs_stereo *found, adcgs_error *error);

#endif
