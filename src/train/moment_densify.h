/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Growth in time: where the pictures of a moment show what the model does not, points that matching found there and then become
 * anchors that live about that moment (spans of life with a velocity: Wang et al. 2025, FreeTimeGS, CVPR).
 */
#ifndef ADCGS_TRAIN_MOMENT_DENSIFY_H
#define ADCGS_TRAIN_MOMENT_DENSIFY_H

#include "train/state.h"

/** Of the points of a few moments, other ones each time, those that the views miss the most, at most `most`; *n of them. */
adcgs_status adcgs_moment_find(adcgs_trainer *trainer, const adcgs_stereo_point **points, uint32_t most, uint32_t *n,
                               adcgs_error *error);

#endif
