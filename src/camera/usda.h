/* SPDX-License-Identifier: BSD-2-Clause */
/**
 * \file
 * As much of USD's text format as cameras take: prims, one in another, and of their properties those that are asked for, with
 * their values at moments. What a file brings in from others (references, payloads, variants) is not looked for.
 */
#ifndef ADCGS_CAMERA_USDA_H
#define ADCGS_CAMERA_USDA_H

#include "base/base.h"

#define ADCGS_USDA_NUMBERS 16 /**< of a value: a matrix */

typedef struct adcgs_usda_sample {
    double at; /**< time code */
    double v[ADCGS_USDA_NUMBERS];
} adcgs_usda_sample;

typedef struct adcgs_usda_property {
    char *name;
    int prim;                 /**< whose it is */
    int n;                    /**< numbers of each value; 0: it is text */
    int n_samples, is_fixed;  /**< samples in the order of their times; fixed: one, of no time */
    adcgs_usda_sample *samples;
    char *text;               /**< of a text, or texts of an array, each ended by a line feed */
} adcgs_usda_property;

typedef struct adcgs_usda_prim {
    int parent;    /**< -1: none */
    char type[32]; /**< "Camera", "Xform"; what is longer is cut off */
} adcgs_usda_prim;

typedef struct adcgs_usda {
    int n_prims, n_properties;
    adcgs_usda_prim *prims;
    adcgs_usda_property *properties; /**< those of prim -1 are the file's own */
} adcgs_usda;

/**
 * Read a file; wanted says which properties are kept. ADCGS_ERR_UNSUPPORTED for binary USD, ADCGS_ERR_DATA, naming the line, for
 * what is none.
 */
adcgs_status adcgs_usda_read(adcgs_usda *out, const char *path, int (*wanted)(const char *name), adcgs_error *error);
void adcgs_usda_free(adcgs_usda *usda);

/** A prim's property; NULL if it has none of that name. */
const adcgs_usda_property *adcgs_usda_find(const adcgs_usda *usda, int prim, const char *name);
/** Its value at a time code: straight between samples, else the nearest one's. out receives n numbers. */
void adcgs_usda_value(const adcgs_usda_property *property, double at, double out[ADCGS_USDA_NUMBERS]);

#endif
