/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Puts a scene into the page for browsers. */
#ifndef ADCGS_TOOLS_SHARE_PAGE_H
#define ADCGS_TOOLS_SHARE_PAGE_H

#include "base/base.h"

#include <stdio.h>

typedef struct adcgs_share_scene {
    const char *name;  /**< of the scene's file; NULL: no scene */
    const char *title; /**< of the page; NULL: the name without its folder */
    const uint8_t *data;
    size_t bytes;
} adcgs_share_scene;

/** ADCGS_ERR_DATA if the page has no place for a scene and a title. path is for messages. */
adcgs_status adcgs_share_check_page(const uint8_t *page, size_t bytes, const char *path, adcgs_error *error);
/** Writes a checked page. Errors stay with the file. */
void adcgs_share_write(FILE *file, const char *page, size_t bytes, const adcgs_share_scene *scene);

#endif
