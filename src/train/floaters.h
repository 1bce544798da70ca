/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Primitives that float before the cameras. Where few cameras look they fit a single view by heart, at any depth, and a camera
 * between the others sees them hang in the air. What matching knows of depths tells them. Known as free-space constraints of
 * multi-view stereo (Kutulakos and Seitz 2000, A theory of shape by space carving, IJCV).
 */
#ifndef ADCGS_TRAIN_FLOATERS_H
#define ADCGS_TRAIN_FLOATERS_H

#include "train/state.h"

/** Primitives of anchors that stand still go where adcgs_stereo_floats(). Leaves the pass as it is without deformation. */
void adcgs_drop_floaters(adcgs_trainer *trainer);

#endif
