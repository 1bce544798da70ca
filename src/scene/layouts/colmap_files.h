/* SPDX-License-Identifier: BSD-2-Clause */
/** \file The three files of a sparse model: finding and reading them. */
#ifndef ADCGS_SCENE_LAYOUTS_COLMAP_FILES_H
#define ADCGS_SCENE_LAYOUTS_COLMAP_FILES_H

#include "scene/layouts/colmap_model.h"

typedef enum adcgs_colmap_file { ADCGS_COLMAP_CAMERAS, ADCGS_COLMAP_IMAGES, ADCGS_COLMAP_POINTS } adcgs_colmap_file;

typedef struct adcgs_colmap_place {
    char *folder; /**< with its slash; NULL: no model */
    int format;
} adcgs_colmap_place;

/** The models of a directory. */
typedef struct adcgs_colmap_models {
    adcgs_colmap_place place, other; /**< the model in use, and the largest of the others, if any */
    uint32_t n;                      /**< number of models */
    size_t images, other_images;     /**< numbers of their images; counted if there are several models */
} adcgs_colmap_models;

/**
 * Looks in sparse/0, sparse, the directory itself and sparse/1, sparse/2, ...; if there is no model, in the same places below
 * colmap/sparse, and then below distorted/sparse. The model with most images is used; among equals the first in this order.
 * first: stop at the first model. ADCGS_ERR_MEMORY; nothing is allocated then.
 */
adcgs_status adcgs_colmap_find(adcgs_colmap_models *out, const char *directory, int first, adcgs_error *error);
void adcgs_colmap_forget(adcgs_colmap_models *models);
void adcgs_colmap_leave(adcgs_colmap_place *place);
/** True if "DIRECTORY/PLACE" contains any file of a model; *format is its format. place is empty or ends with its slash. */
int adcgs_colmap_format(const char *directory, const char *place, int *format);
int adcgs_colmap_has(const adcgs_colmap_place *place, adcgs_colmap_file file);
/** The extension of a file: "bin" or "txt". A file has the format of its place, or the other if it exists only in that. */
const char *adcgs_colmap_end(const adcgs_colmap_place *place, adcgs_colmap_file file);
/** Reads one of the files, and sorts its elements. ADCGS_ERR_DATA, naming the file, if it is missing. */
adcgs_status adcgs_colmap_load(adcgs_colmap *model, const adcgs_colmap_place *place, adcgs_colmap_file file, adcgs_error *error);

#endif
