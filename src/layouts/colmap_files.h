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

/** The models of a directory. */
typedef struct adcgs_colmap_models {
    adcgs_colmap_place place, other; /**< the one that is taken, and the largest of the others, if there is one */
    uint32_t n;                      /**< how many there are */
    size_t images, other_images;     /**< that they have; counted where there are several */
} adcgs_colmap_models;

/**
 * In sparse/0, sparse, the directory itself and sparse/1, sparse/2, ...; where there is none, the same below colmap/sparse, and
 * then below distorted/sparse. Of several the one with most images is taken, of those with as many the first in this order.
 * first: no other is looked for once one is found. ADCGS_ERR_MEMORY; then nothing is left.
 */
adcgs_status adcgs_colmap_find(adcgs_colmap_models *out, const char *directory, int first, adcgs_error *error);
void adcgs_colmap_forget(adcgs_colmap_models *models);
void adcgs_colmap_leave(adcgs_colmap_place *place);
/** Whether any file of a model is in "DIRECTORY/PLACE", where place is empty or ends with its slash, and of which format. */
int adcgs_colmap_format(const char *directory, const char *place, int *format);
int adcgs_colmap_has(const adcgs_colmap_place *place, adcgs_colmap_file file);
/** How names of the files end: "bin" or "txt". */
const char *adcgs_colmap_end(const adcgs_colmap_place *place);
/** Read one of them, and sort what it lists. ADCGS_ERR_DATA, naming it, if it is missing. */
adcgs_status adcgs_colmap_load(adcgs_colmap *model, const adcgs_colmap_place *place, adcgs_colmap_file file, adcgs_error *error);

#endif
