/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Pruning of floaters. Where few cameras look, primitives overfit a single view at any depth, and a camera between the others
 * sees them float. The depths from matching reveal them. Known as free-space constraints of multi-view stereo (Kutulakos and
 * Seitz 2000, A theory of shape by space carving, IJCV).
 */
#ifndef ADCGS_TRAIN_DENSITY_FLOATERS_H
#define ADCGS_TRAIN_DENSITY_FLOATERS_H

#include "train/state/state.h"

/** Drops primitives of static anchors where adcgs_stereo_floats(). Leaves the pass in its state without deformation. */
void adcgs_drop_floaters(adcgs_trainer *trainer);

#endif
