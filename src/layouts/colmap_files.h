/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The three files of a sparse model: where they are, and reading them. */
#ifndef ADCGS_LAYOUTS_COLMAP_FILES_H
#define ADCGS_LAYOUTS_COLMAP_FILES_H

#include "layouts/colmap_model.h"

typedef enum adcgs_colmap_file { ADCGS_COLMAP_CAMERAS, ADCGS_COLMAP_IMAGES, ADCGS_COLMAP_POINTS } adcgs_colmap_file;

typedef struct adcgs_colmap_place {
    char *folder; /**< with its slash; NULL: there is no model */
    int format;
} adcgs_colmap_place;

/** In sparse/0, sparse or the directory itself, whichever has any of the files. ADCGS_ERR_MEMORY. */
adcgs_status adcgs_colmap_find(adcgs_colmap_place *out, const char *directory, adcgs_error *error);
void adcgs_colmap_leave(adcgs_colmap_place *place);
int adcgs_colmap_has(const adcgs_colmap_place *place, adcgs_colmap_file file);
/** How names of the files end: "bin" or "txt". */
const char *adcgs_colmap_end(const adcgs_colmap_place *place);
/** Read one of them, and sort what it lists. ADCGS_ERR_DATA, naming it, if it is missing. */
adcgs_status adcgs_colmap_load(adcgs_colmap *model, const adcgs_colmap_place *place, adcgs_colmap_file file, adcgs_error *error);

#endif
