/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The amount of detail in a scene's images, from which its maximum number of anchors follows (resolve.h). */
#ifndef ADCGS_TRAIN_ANCHOR_PLAN_H
#define ADCGS_TRAIN_ANCHOR_PLAN_H

#include "scene/scene.h"

/**
 * Mean number of details (metric/detail.h) of a few training images, evenly spread, at the size used for training: images are
 * reduced by the factor `divide`.
 */
adcgs_status adcgs_plan_details(const adcgs_scene *scene, int divide, uint32_t *details, adcgs_error *error);

#endif
