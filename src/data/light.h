/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Light that steps. Where a recorder changes its exposure or its white balance, or a lamp is switched, all of a scene seems to
 * change at once. A model can only follow with all it has, and is blurred for it. Who does not want the step has pictures behind
 * it taken back by one factor a channel, from where they are loaded on: whatever is matched, learnt and measured in training is
 * of even light.
 */
#ifndef ADCGS_DATA_LIGHT_H
#define ADCGS_DATA_LIGHT_H

#include "data/faults.h"
#include "data/pictures.h"

/**
 * Set stops of views: what the light of a camera's pictures gains at those that are behind a step (adcgs_fault_light()), added up
 * from its first, which has none.
 */
void adcgs_light_add_up(adcgs_scene_view *views, const uint8_t *behind, const adcgs_tracks *tracks, const adcgs_glance *glances);

/**
 * Set stops of a scene's training views: zeros, but for those behind a step of a camera's light (faults.h), which become as its
 * first pictures are. All pictures are loaded for it, small, and forgotten. found: the step that most cameras have, for who tells
 * of it; its cameras are 0 where there is none. config: who is told of progress, and how much memory there is.
 */
adcgs_status adcgs_light_even(adcgs_scene *scene, adcgs_fault *found, const adcgs_pictures_config *config, adcgs_pool *pool,
                              adcgs_error *error);

#endif
