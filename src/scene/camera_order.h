/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The views of each camera in ascending time: a video, even if it came as single images. */
#ifndef ADCGS_SCENE_CAMERA_ORDER_H
#define ADCGS_SCENE_CAMERA_ORDER_H

#include "scene/scene.h"

typedef struct adcgs_camera_order {
    uint32_t n;      /**< fixed cameras; 1 for one moving camera that took everything; 0: neither */
    uint32_t *begin; /**< [n + 1] start of each camera in order */
    uint32_t *order; /**< [views] indices of views, camera by camera, in ascending time */
    int moves;       /**< nonzero: it is one moving camera */
} adcgs_camera_order;

/**
 * Views whose cameras are equal to the last bit are of one fixed camera (group_views.h). If hardly any two are equal, and no two
 * views have the same time, there is one moving camera. Several moving cameras cannot be distinguished: n is 0.
 */
adcgs_status adcgs_camera_order_find(adcgs_camera_order *tracks, const adcgs_scene_view *views, uint32_t n, adcgs_error *error);
void adcgs_camera_order_clear(adcgs_camera_order *tracks);

#endif
