/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Maximum number of anchors of a scene, from the amount of detail in its images. */
#ifndef ADCGS_TRAIN_ANCHOR_PLAN_H
#define ADCGS_TRAIN_ANCHOR_PLAN_H

#include "scene/scene.h"
#include "train/train_config.h"

/**
 * Sets max_anchors, unless the user set it, and limits start_anchors to it. The value is config->detail_anchors times the square
 * root of *details: the details (metric/detail.h) per image, averaged over a few training images. The growth is less than
 * proportional: with the same number of iterations, each detail of a busy image is trained less and is worth fewer bits. All
 * parts of a scene get the number of the whole scene. *details is 0 if it is not needed. With config->has_details, no image is
 * read.
 */
adcgs_status adcgs_plan_anchors(adcgs_train_config *config, const adcgs_scene *scene, uint32_t *details, adcgs_error *error);
/** Mean number of details of a few training images, evenly spread, at the size used for training. */
adcgs_status adcgs_plan_details(const adcgs_scene *scene, int divide, uint32_t *details, adcgs_error *error);

#endif
