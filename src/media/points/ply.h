/* SPDX-License-Identifier: BSD-2-Clause */
/** \file
 * PLY in memory, for the readers of points and of splats: the header, and the
 * numbers of the element "vertex". Lists are skipped, and so are other elements
 * that the reader does not ask for. Every count is checked against the bytes
 * present before anything is allocated.
 */
#ifndef ADCGS_MEDIA_POINTS_PLY_H
#define ADCGS_MEDIA_POINTS_PLY_H

#include "base/base.h"

/* Origin, unless a line states one: chosen by hand, not measured. */
#define ADCGS_PLY_PROPERTIES 1024 /**< maximum number per element; splats with features have hundreds */
#define ADCGS_PLY_BEFORE 8        /**< maximum number of elements before the vertices */

typedef enum adcgs_ply_type {
    ADCGS_PLY_INT8,
    ADCGS_PLY_UINT8,
    ADCGS_PLY_INT16,
    ADCGS_PLY_UINT16,
    ADCGS_PLY_INT32,
    ADCGS_PLY_UINT32,
    ADCGS_PLY_FLOAT32,
    ADCGS_PLY_FLOAT64,
    ADCGS_PLY_TYPES
} adcgs_ply_type;

typedef struct adcgs_ply_property {
    char name[64];
    adcgs_ply_type type;
    adcgs_ply_type count_type; /**< of a list */
    int is_list;
    int role; /**< assigned by the reader; -1, the initial value, if it ignores the property */
} adcgs_ply_property;

typedef struct adcgs_ply_element {
    char name[64];
    uint64_t count;
    const uint8_t *at; /**< its first item; NULL for the vertices and elements after them */
    int line, n;
    adcgs_ply_property properties[ADCGS_PLY_PROPERTIES];
} adcgs_ply_element;

typedef enum adcgs_ply_form { ADCGS_PLY_ASCII, ADCGS_PLY_LITTLE, ADCGS_PLY_BIG } adcgs_ply_form;

typedef struct adcgs_ply {
    const uint8_t *header, *at, *end;
    const char *path;
    adcgs_error *error;
    adcgs_ply_form form;
    int line;
    uint8_t line_end; /**< line terminator in the header: LF, with or without CR before it, or CR alone */
    int n_before, has_vertex, has_after;
    adcgs_ply_element vertex, after, before[ADCGS_PLY_BEFORE]; /**< after: the next one after the vertices; others are ignored */
} adcgs_ply;

/** True if the bytes begin like a PLY file. */
int adcgs_ply_is(const uint8_t *data, size_t bytes);
/** The name of a type in headers: "float". */
const char *adcgs_ply_type_name(adcgs_ply_type type);

/**
 * Parse the header of `bytes` bytes at data. The caller owns them; a zero byte must follow, as from adcgs_file_load(). path and
 * error are for messages of this call and of adcgs_ply_vertices(). ADCGS_ERR_DATA without the header of a PLY file with vertices,
 * or if it declares more vertices than can follow. On failure *out is NULL.
 */
adcgs_status adcgs_ply_open(adcgs_ply **out, const uint8_t *data, size_t bytes, const char *path, adcgs_error *error);
void adcgs_ply_close(adcgs_ply **ply);

/**
 * The text of the header's next comment, without the keyword and surrounding white space: *at and *n, in the data, of any length
 * and with any bytes. Set *at to NULL before the first call. \return 0 without another comment
 */
int adcgs_ply_comment(const adcgs_ply *ply, const char **at, size_t *n);

/** A vertex's property by name; NULL if there is none, or it is a list. */
adcgs_ply_property *adcgs_ply_find(adcgs_ply *ply, const char *name);

/** Receives one number of a vertex. */
typedef void (*adcgs_ply_take_fn)(void *user, uint64_t vertex, const adcgs_ply_property *property, double value);
/** Pass every number of a property with a role to take(), in file order. */
adcgs_status adcgs_ply_vertices(adcgs_ply *ply, adcgs_ply_take_fn take, void *user);
/** Like adcgs_ply_vertices(), but keeps the position in the file, so that the vertices can be read again. */
adcgs_status adcgs_ply_survey(adcgs_ply *ply, adcgs_ply_take_fn take, void *user);
/** An element by name: one before the vertices, or the one that follows them; else NULL. */
adcgs_ply_element *adcgs_ply_find_element(adcgs_ply *ply, const char *name);
/** An element's property by name; NULL if there is none, or it is a list. */
adcgs_ply_property *adcgs_ply_find_in(adcgs_ply_element *element, const char *name);
/**
 * Like adcgs_ply_vertices() for an element from adcgs_ply_find_element(). The one after the vertices is read once, after
 * adcgs_ply_vertices().
 */
adcgs_status adcgs_ply_items(adcgs_ply *ply, const adcgs_ply_element *element, adcgs_ply_take_fn take, void *user);
/** Sets the offset of all positions, from a comment "offset X Y Z"; zero without one. */
void adcgs_ply_offset(const adcgs_ply *ply, double offset[3]);

#endif
