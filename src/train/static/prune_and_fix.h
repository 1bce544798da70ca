/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decisions by measured effect: whether anything moves at all, which anchors move, and which primitives are visible. Cf. the
 * masks of compact 3D Gaussian splatting (Lee et al., CVPR 2024), which are trained.
 */
#ifndef ADCGS_TRAIN_STATIC_PRUNE_AND_FIX_H
#define ADCGS_TRAIN_STATIC_PRUNE_AND_FIX_H

#include "train/state/state.h"

/**
 * Tests if motion is worth its bytes. If freezing time costs less image loss than the deformation networks cost in rate, all
 * anchors become static. Runs at rate_start, so that the rest of the run can compensate.
 */
adcgs_status adcgs_test_motion_gain(adcgs_trainer *trainer, adcgs_error *error);

/**
 * Makes anchors static that are rendered where the images of static cameras never change. Runs at rate_start, so that the rest of
 * the run can compensate. adcgs_prune_and_fix() runs it again, because anchors have grown by then.
 */
adcgs_status adcgs_fix_unchanging(adcgs_trainer *trainer, adcgs_error *error);

/** Drops primitives without effect, and marks static anchors. */
adcgs_status adcgs_prune_and_fix(adcgs_trainer *trainer, adcgs_error *error);

#endif
