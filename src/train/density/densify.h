/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Densification: anchors grow where the image gradient indicates too few primitives, and idle anchors are pruned. Both are
 * weighted by temporal significance (paper section 3.5). After the adaptive density control of Kerbl et al. (3D Gaussian
 * Splatting, SIGGRAPH 2023) and the anchor refinement of Lu et al. (Scaffold-GS, CVPR 2024).
 */
#ifndef ADCGS_TRAIN_DENSITY_DENSIFY_H
#define ADCGS_TRAIN_DENSITY_DENSIFY_H

#include "train/state/state.h"

/** Grows and prunes anchors; progress in [0,1]. */
adcgs_status adcgs_densify(adcgs_trainer *trainer, double progress, adcgs_error *error);
/** Maximum number of anchors at this progress. */
double adcgs_densify_budget(const adcgs_train_config *config, double progress);

#endif
