/* SPDX-License-Identifier: BSD-2-Clause */
/** \file How many anchors a scene needs at most, from how much there is to see in its pictures. */
#ifndef ADCGS_TRAIN_ANCHOR_PLAN_H
#define ADCGS_TRAIN_ANCHOR_PLAN_H

#include "data/scene.h"
#include "train/config.h"

/**
 * Unless it was chosen by hand, max_anchors becomes config->detail_anchors times the square root of the details (metric/detail.h)
 * of the mean of a few training pictures, and start_anchors no more than that; *details is their number, 0: nobody asked. Of what
 * a busy picture holds each thing is learnt less well in as many iterations, and pays for less. All parts of a scene have as many
 * as the whole. Where config->has_details says that they are known, no picture is looked at.
 */
adcgs_status adcgs_plan_anchors(adcgs_train_config *config, const adcgs_scene *scene, uint32_t *details, adcgs_error *error);
/** Details in the mean of a few of the pictures, evenly spread over those for training, as they are trained on. */
adcgs_status adcgs_plan_details(const adcgs_scene *scene, int divide, uint32_t *details, adcgs_error *error);

#endif
