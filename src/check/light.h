/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Compensation of light steps. When a recorder changes its exposure or white balance, or a lamp is switched, the whole scene
 * seems to change at once. A model can follow only by changing as a whole, and becomes blurred. With compensation, images
 * behind a step are scaled back by one factor per channel when they are loaded. Matching, training and measuring in training
 * then all see constant light.
 */
#ifndef ADCGS_CHECK_LIGHT_H
#define ADCGS_CHECK_LIGHT_H

#include "check/faults.h"
#include "scene/image_store.h"

/**
 * Sets stops of views: the gains of a camera's images at steps of light (adcgs_fault_light()), accumulated from its first
 * image, which has none.
 */
void adcgs_light_add_up(adcgs_scene_view *views, const uint8_t *behind, const adcgs_camera_order *tracks,
                        const adcgs_thumbnail *thumbnails);

/**
 * Sets stops of a scene's training views: zeros, except behind a light step of a camera (faults.h), where images become like
 * the camera's first ones. Loads small versions of all images for this, and discards them. found: the step that most cameras
 * share, for reports; its cameras are 0 without a step. config: progress callback and memory limit.
 */
adcgs_status adcgs_light_compensate(adcgs_scene *scene, adcgs_fault *found, const adcgs_image_store_config *config,
                                    adcgs_pool *pool, adcgs_error *error);

#endif
