/* SPDX-License-Identifier: BSD-2-Clause */
/** \file Streams of attributes in a .4dgs file's chunks, as integers: bins of the steps, indices, flags. */
#ifndef ADCGS_MEDIA_DYNAMIC_FOURDGS_STREAMS_H
#define ADCGS_MEDIA_DYNAMIC_FOURDGS_STREAMS_H

#include "media/dynamic/fourdgs.h"

/* Places of attributes in a row of integers. Origin: arithmetic, sums of the attributes' components. */
enum {
    ADCGS_FOURDGS_ROW_POSITION = 0,
    ADCGS_FOURDGS_ROW_SCALE = 3,
    ADCGS_FOURDGS_ROW_OMITTED = 6,
    ADCGS_FOURDGS_ROW_ROTATION = 7,
    ADCGS_FOURDGS_ROW_COLOUR = 10,
    ADCGS_FOURDGS_ROW_OPACITY = 13,
    ADCGS_FOURDGS_ROW_MOTION = 14,
    ADCGS_FOURDGS_ROW_CENTRE = 17,
    ADCGS_FOURDGS_ROW_SIGMA = 18,
    ADCGS_FOURDGS_ROW_FLAGS = 19,
    ADCGS_FOURDGS_ROW_WINDOW = 20,
    ADCGS_FOURDGS_ROW_ID = 21,     /* the bits of an unsigned number */
    ADCGS_FOURDGS_ROW_OBJECT = 22, /* the same */
    ADCGS_FOURDGS_ROW
};

/** Integers of one attribute: component c of element i is values[i * stride + c]. */
typedef struct adcgs_fourdgs_column {
    int32_t *values; /**< NULL: absent */
    uint32_t stride; /**< 0: all elements are equal */
} adcgs_fourdgs_column;

typedef struct adcgs_fourdgs_columns {
    uint32_t n;
    adcgs_fourdgs_column column[ADCGS_FOURDGS_ATTRIBUTES];
} adcgs_fourdgs_columns;

extern const int adcgs_fourdgs_channels[ADCGS_FOURDGS_ATTRIBUTES];
extern const int adcgs_fourdgs_places[ADCGS_FOURDGS_ATTRIBUTES]; /**< in a row */

/**
 * Read streams of n elements that lie back to back. Others than those wanted are skipped; ADCGS_ERR_DATA if a required one is
 * absent. where: "chunk 3", for messages. Also on failure the caller calls adcgs_fourdgs_columns_free().
 */
adcgs_status adcgs_fourdgs_columns_read(adcgs_fourdgs_columns *out, adcgs_byte_cursor block, uint32_t n, int wanted, int required,
                                        const char *path, const char *where, adcgs_error *error);
void adcgs_fourdgs_columns_free(adcgs_fourdgs_columns *columns);
/** Element i as a row; absent attributes are 0. */
void adcgs_fourdgs_row(int32_t row[ADCGS_FOURDGS_ROW], const adcgs_fourdgs_columns *columns, uint32_t i);
/** Unpack a chunk's block of streams, from malloc(). */
adcgs_status adcgs_fourdgs_block(uint8_t **block, const adcgs_fourdgs_chunk *chunk, const char *path, const char *where,
                                 adcgs_error *error);
/** Coefficients per channel above degree 0. */
static inline size_t adcgs_fourdgs_coefficients(int degree)
{
    return (size_t)((degree + 1) * (degree + 1) - 1);
}
/** Read the bands of a chunk's splats up to a degree, in the order of adcgs_splats: bytes [n][3][coefficients]. */
adcgs_status adcgs_fourdgs_bands_read(uint8_t *out, const adcgs_fourdgs_chunk *chunk, int degree, const char *path,
                                      const char *where, adcgs_error *error);

#endif
