/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Writes the page for browsers with a scene, its texts and its poster. */
#ifndef ADCGS_APPS_SHARE_SHARE_PAGE_H
#define ADCGS_APPS_SHARE_SHARE_PAGE_H

#include "base/base.h"

#include <stdio.h>

/** The image that the page shows before the decoder starts: a file's bytes. */
typedef struct adcgs_share_poster {
    uint8_t *data; /**< from malloc(); NULL: no poster */
    size_t bytes;
    int width, height;
    const char *type; /**< "image/jpeg" */
} adcgs_share_poster;

/** The sound that the page plays with the scene: a file's bytes. */
typedef struct adcgs_share_sound {
    uint8_t *data; /**< from malloc(); NULL: no sound */
    size_t bytes;
    const char *type; /**< "audio/ogg" */
    double offset;    /**< time of the scene at which the file begins, seconds */
} adcgs_share_sound;

typedef struct adcgs_share_scene {
    const char *name;       /**< of the scene's file; NULL: no scene */
    const char *title;      /**< NULL: the name without its folder and its ending */
    const char *credit;     /**< who made it; or NULL */
    const char *background; /**< colour of the page, #rrggbb; NULL: the page's own */
    const char *image;      /**< address of the image for links to the page; or NULL */
    int camera;             /**< index of the stored camera of the first view; -1: as in the player */
    int has_time;
    double time; /**< of the first frame, seconds */
    int is_once; /**< true: the page does not play in a loop */
    const uint8_t *data;
    size_t bytes;
    adcgs_share_poster poster;
    adcgs_share_sound sound;
} adcgs_share_scene;

/** ADCGS_ERR_DATA if the page lacks one of the places that the scene needs. path is for messages. */
adcgs_status adcgs_share_check_page(const uint8_t *page, size_t bytes, const char *path, adcgs_error *error);
/** Writes a checked page. Errors stay with the file. */
void adcgs_share_write(FILE *file, const char *page, size_t bytes, const adcgs_share_scene *scene);

#endif
