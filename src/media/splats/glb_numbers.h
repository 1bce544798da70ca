/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * Numbers of a GLB file. An attribute's accessor is checked against the file's
 * contents before anything is read.
 */
#ifndef ADCGS_MEDIA_SPLATS_GLB_NUMBERS_H
#define ADCGS_MEDIA_SPLATS_GLB_NUMBERS_H

#include "base/base.h"

#include <jansson.h>

typedef struct adcgs_glb {
    const char *path;
    adcgs_error *error;
    json_t *root;           /**< the caller frees it */
    json_t *attributes;     /**< of the primitive, in root */
    const uint8_t *numbers; /**< the binary chunk; NULL without one */
    size_t n_bytes;
} adcgs_glb;

typedef struct adcgs_glb_view {
    const uint8_t *at;
    size_t stride;
    uint32_t count; /**< 1 to ADCGS_SPLATS_MAX */
    int type;       /**< component type, a code of glTF */
    int is_normal;  /**< integers represent -1..1 or 0..1 */
} adcgs_glb_view;

/** Find a required attribute with this number of components. All bytes of the returned view lie in the binary chunk. */
adcgs_status adcgs_glb_find(adcgs_glb_view *view, const adcgs_glb *glb, const char *name, int components);
/** The bytes of the view that an object of the file refers to. name: the object, for messages. */
adcgs_status adcgs_glb_bytes(const uint8_t **at, size_t *bytes, const adcgs_glb *glb, json_t *object, const char *name);
/** Component c of element i; both must exist. */
double adcgs_glb_number(const adcgs_glb_view *view, uint32_t i, int c);

#endif
