/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Rigid bodies of a run that goes on with the segment before. Matching follows them anew, from the first moment on, without
 * knowing of those that there are: they are told apart by where they are then, and their poses are put together with that in
 * which each was left.
 */
#ifndef ADCGS_TRAIN_FOLLOW_BODIES_H
#define ADCGS_TRAIN_FOLLOW_BODIES_H

#include "fmodel/fmodel.h"
#include "stereo/stereo.h"

/**
 * Give the bodies that were found the numbers of the model's, whose time table begins where the segment before was left; poses
 * take the model's anchors from where they rest to where things are. A body that is new gets a number that is free, and goes
 * without if there is none. found->body[b - 1] is then of body b, with no poses if it was not found.
 */
adcgs_status adcgs_follow_bodies(const adcgs_fmodel *f, adcgs_stereo *found, adcgs_error *error);

#endif
