/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The training views and their images. Owned by train_views.c; not in checkpoints. */
#ifndef ADCGS_TRAIN_STATE_VIEW_STATE_H
#define ADCGS_TRAIN_STATE_VIEW_STATE_H

#include "render/render.h"
#include "scene/image_store.h"

typedef struct adcgs_train_view {
    adcgs_view view;
    float t;
} adcgs_train_view;

/** Zero-initialise. */
typedef struct adcgs_view_state {
    uint32_t n;
    adcgs_train_view *list;             /**< [n] */
    adcgs_image_store *store;           /**< images of the views */
    int divide;                         /**< of the loaded images; 0: none */
    uint64_t memory;                    /**< maximum bytes of images; 0: half of the machine's memory */
    adcgs_image_store_progress loading; /**< called for each loaded image, or NULL */
    void *loading_user;
    adcgs_thumbnail *thumbnails; /**< [n] of loaded images, owned by the caller; NULL: not wanted */
    uint8_t content[16];         /**< of the images' files; see adcgs_scene_content() */
    int has_content;             /**< 1: known; computed once, when a file needs it */
} adcgs_view_state;

#endif
