/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Decisions on what a model needs, by measured effect: whether anything moves at all, which anchors move, which primitives are
 * seen. Cf. the masks of compact 3D Gaussian splatting (Lee et al., CVPR 2024), which are learned instead.
 */
#ifndef ADCGS_TRAIN_DECIDE_H
#define ADCGS_TRAIN_DECIDE_H

#include "train/state.h"

/**
 * Whether motion is worth its bytes at all: if stopping time costs the pictures less than the deformation networks cost the
 * file, every anchor becomes static. Done when rate begins, so that the rest of the run makes up for what the networks had
 * taken over.
 */
adcgs_status adcgs_weigh_motion(adcgs_trainer *trainer, adcgs_error *error);

/**
 * Mark anchors as static that are drawn where the pictures of resting cameras never change. Done when rate begins, so that the
 * rest of the run makes up for what had been drawn moved; by adcgs_decide() once more, since anchors have grown then.
 */
adcgs_status adcgs_rest_unchanging(adcgs_trainer *trainer, adcgs_error *error);

/** Drop primitives that never matter and mark anchors that never move. */
adcgs_status adcgs_decide(adcgs_trainer *trainer, adcgs_error *error);

#endif
