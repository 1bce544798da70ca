/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * The part of USD's text format that cameras need: nested prims, and the wanted
 * properties with their values at time codes. Content from other files
 * (references, payloads, variants) is ignored.
 */
#ifndef ADCGS_CAMERA_USDA_H
#define ADCGS_CAMERA_USDA_H

#include "base/base.h"

#define ADCGS_USDA_NUMBERS 16 /**< numbers of a value, at most: those of a matrix4d, by definition of USD */

typedef struct adcgs_usda_sample {
    double at; /**< time code */
    double v[ADCGS_USDA_NUMBERS];
} adcgs_usda_sample;

typedef struct adcgs_usda_property {
    char *name;
    int prim;                /**< owner */
    int n;                   /**< numbers per value; 0: the property is text */
    int n_samples, is_fixed; /**< samples in order of time; fixed: a single one without a time */
    adcgs_usda_sample *samples;
    char *text; /**< the text, or the texts of an array, each ended by a line feed */
} adcgs_usda_property;

typedef struct adcgs_usda_prim {
    int parent;    /**< -1: none */
    char type[32]; /**< "Camera", "Xform"; longer types are truncated */
} adcgs_usda_prim;

typedef struct adcgs_usda {
    int n_prims, n_properties;
    adcgs_usda_prim *prims;
    adcgs_usda_property *properties; /**< those of prim -1 are the file's own */
} adcgs_usda;

/**
 * Read a file; wanted() selects the properties to keep. ADCGS_ERR_UNSUPPORTED for binary USD. ADCGS_ERR_DATA, naming the line,
 * for a file that is not USD text.
 */
adcgs_status adcgs_usda_read(adcgs_usda *out, const char *path, int (*wanted)(const char *name), adcgs_error *error);
void adcgs_usda_free(adcgs_usda *usda);

/** A prim's property; NULL if it has none of that name. */
const adcgs_usda_property *adcgs_usda_find(const adcgs_usda *usda, int prim, const char *name);
/** Value at a time code: interpolated linearly between samples, else the nearest sample's. out receives n numbers. */
void adcgs_usda_value(const adcgs_usda_property *property, double at, double out[ADCGS_USDA_NUMBERS]);

#endif
